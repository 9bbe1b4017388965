"""Programs that a launcher runs on several ranks."""

import subprocess


def end(process):
    """Asks a launcher to end itself and its ranks, then insists."""
    process.terminate()
    try:
        process.communicate(timeout=10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()

"""Makes runs of squeal, several at a time, each on one rank, and says how long it will still take. What is complete is
not made again; when stopped, the runs under way are ended, and made again the next time."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

from ..run.kept_runs import KeptRun
from ..run.program import ROOT

PERIOD = 10.0  # s between two lines where there is no terminal
GRACE = 10.0  # s that a run has to end itself
LEFT = re.compile(r"^step .*? t ([\d.]+) ms", re.MULTILINE)
END = re.compile(r"-ts_max_time ([\d.e+-]+)")


def processor_seconds():
    """Of all processes that have ended and been waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Job:
    """A run of the plan in its folder."""

    def __init__(self, planned, program, folder, coarse):
        self.planned, self.name, self.seconds = planned, planned.name, planned.lasts(coarse)
        words = [*planned.words(coarse), "-squeal_progress", 0]
        self.kept = KeptRun(program, 1, folder / planned.name, words)
        self.commands, self.process, self.begun, self.took, self.error = [], None, 0.0, None, ""
        self.done, self.processor = self.kept.is_complete(), 0.0

    def start(self):
        """In a group of its own, so that ^C reaches it through stop() only, and ends with its parent."""
        self.commands = [self.kept.begin()]
        if self.planned.after:
            self.commands.append([sys.executable, str(ROOT / "scripts" / self.planned.after), str(self.kept.folder)])
        self.begun = time.monotonic()
        self.go_on("w")

    def go_on(self, mode="a"):
        """The next of its commands; mode: of the files that have what it prints."""
        command = ["setpriv", "--pdeathsig", "TERM", *self.commands.pop(0)]
        with self.part("out").open(mode) as out, self.part("err").open(mode) as err:
            self.process = subprocess.Popen(command, stdout=out, stderr=err, stdin=subprocess.DEVNULL,
                                            start_new_session=True)

    def part(self, kind):
        """File of what it prints."""
        return self.kept.folder / f"{kind}.part"

    def share(self):
        """How much of it is done, where its output tells."""
        times = LEFT.findall(self.part("out").read_text(errors="replace"))
        end = END.findall(" ".join(self.kept.words))
        return min(1e-3 * float(times[-1]) / float(end[-1]), 1.0) if times and end else 0.0

    def has_ended(self):
        """Whether it has; then it is complete, or `error` says why not."""
        before = processor_seconds()
        if self.process.poll() is None:
            return False
        self.processor += processor_seconds() - before
        if self.process.returncode == 0 and self.commands:
            self.go_on()
            return False
        text, said = (self.part(kind).read_text(errors="replace") for kind in ("out", "err"))
        self.took = time.monotonic() - self.begun
        if self.process.returncode == 0:
            self.kept.end(text)
            self.done = True
        else:
            self.error = (said.strip().splitlines() or [f"ended with status {self.process.returncode}"])[-1]
        for kind in ("out", "err"):
            self.part(kind).unlink()
        return True

    def stop(self):
        """Ends the process, at once if it does not end itself."""
        if not self.process:
            return
        for sign, patience in ((signal.SIGTERM, GRACE), (signal.SIGKILL, None)):
            try:
                os.killpg(self.process.pid, sign)
                self.process.wait(patience)
                return
            except (ProcessLookupError, subprocess.TimeoutExpired):
                continue

    def left(self, pace):
        """Seconds that it will still take; `pace`: over the plan."""
        if self.done or self.error:
            return 0.0
        if not self.process:
            return pace * self.seconds
        ran, share = time.monotonic() - self.begun, self.share()
        return ran * (1 - share) / share if share > 0.02 else max(pace * self.seconds - ran, 1.0)


def duration(seconds):
    """4 min 10 s"""
    minutes, rest = divmod(int(seconds + 0.5), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


class Screen:
    """One line that is written over on a terminal, else a line now and then; what has ended gets a line that stays."""

    def __init__(self, file=sys.stderr):
        self.file, self.terminal, self.shown, self.width = file, file.isatty(), -PERIOD, 0

    def show(self, text):
        """What goes on."""
        if not self.terminal and time.monotonic() - self.shown < PERIOD:
            return
        self.shown = time.monotonic()
        if self.terminal:
            text = text[:shutil.get_terminal_size().columns - 1]
        self.write(text, "" if self.terminal else "\n")
        self.width = len(text)

    def say(self, text):
        """What stays."""
        self.write(text, "\n")
        self.width = 0

    def write(self, text, end):
        """Over what the line of a terminal shows."""
        if self.terminal:
            text = "\r" + text.ljust(self.width)
        print(text, end=end, file=self.file, flush=True)


class Work:
    """All runs, `n` of them at a time."""

    def __init__(self, jobs, n, screen):
        self.jobs, self.n, self.screen = jobs, n, screen
        self.waiting = [job for job in jobs if not job.done]
        self.running = []

    def pace(self):
        """Time that was taken over what was planned, 1 before anything is known."""
        known = [(job.took, job.seconds) for job in self.jobs if job.took and job.done]
        for job in self.running:
            share = job.share()
            if share > 0.02:
                known.append((time.monotonic() - job.begun, share * job.seconds))
        return sum(took for took, _ in known) / sum(planned for _, planned in known) if known else 1.0

    def left(self):
        """Seconds to the end."""
        pace = self.pace()
        each = [job.left(pace) for job in self.jobs]
        return max(sum(each) / self.n, *each, 0.0)

    def line(self):
        """3 of 11 runs, 4 min 10 s left: time-25.1 42 %, sweep"""
        names = [job.name + (f" {100 * job.share():.0f} %" if job.share() else "") for job in self.running]
        return (f"{sum(job.done for job in self.jobs)} of {len(self.jobs)} runs, about {duration(self.left())} left: "
                f"{', '.join(names)}")

    def take_ended(self):
        """Says what has ended."""
        for job in [job for job in self.running if job.has_ended()]:
            self.running.remove(job)
            self.screen.say(f"{job.name}: FAILED, {job.error}" if job.error else
                            f"{job.name}: {duration(job.took)}, {duration(job.processor)} of a processor")

    def do(self):
        """All of it. Stopped by ^C or SIGTERM, the runs under way are ended first."""
        before = signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            while self.waiting or self.running:
                while self.waiting and len(self.running) < self.n:
                    self.running.append(self.waiting.pop(0))
                    self.running[-1].start()
                self.screen.show(self.line())
                time.sleep(0.2)
                self.take_ended()
        finally:
            for job in self.running:
                job.stop()
            signal.signal(signal.SIGTERM, before)

"""One run that copies itself at each of its calls that is to fail: the Python side of branch.c, which says how."""

import os
import shutil
import signal
import socket
import struct
import threading

import served

PATIENCE = 1800  # s, of all copies of a run together


class Branches:
    """The run, in a folder of which `out` is watched; each() lets its calls fail in turn, `outcome` is how it ends itself."""

    def __init__(self, serve, folder, words, environment):
        self.serve, self.out, self.kept = serve, folder / "out", folder / "out.kept"
        self.line = serve.line("branches", PATIENCE)
        self.said = self.line.folder / "stderr"
        address, self.outcome = str(self.line.folder / "ask"), None
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(address)
            listener.listen(1)
            listener.settimeout(serve.limit)
            self.run = threading.Thread(target=self.begin, args=(folder, words, {**environment, "FAULT_ASK": address}))
            self.run.start()
            self.connection, _ = listener.accept()
        os.unlink(address)

    def begin(self, *run):
        self.outcome = self.line.run(*run)

    def hear(self, form):
        """A record of the run; nothing where it has ended."""
        size = struct.calcsize(form)
        data = self.connection.recv(size, socket.MSG_WAITALL)
        return struct.unpack(form, data) if len(data) == size else ()

    def tell(self, number):
        self.connection.sendall(struct.pack("q", number))

    def each(self, numbers):
        """For each of these calls that came: its number, words, and how the copy of the run ended, while its folder is there."""
        for number in numbers:
            self.tell(number)
            record = self.hear("q240s")
            if not record:
                break
            self.out.rename(self.kept)
            shutil.copytree(self.kept, self.out)
            before = self.said.stat().st_size
            self.tell(0)
            status = self.wait()
            stderr = self.said.read_bytes()[before:].decode(errors="replace")
            yield number, record[1].split(b"\0")[0].decode(errors="replace"), served.Outcome(status, "", stderr)
            shutil.rmtree(self.out)
            self.kept.rename(self.out)
        else:
            self.tell(0)
        self.run.join()
        self.connection.close()
        self.line.connection.close()

    def wait(self):
        """How the copy ends: exit status, negative for a signal, None where it had to be killed."""
        (copy,), late = self.hear("q"), []
        if copy <= 0:
            raise SystemExit("FAILED: the run could not copy itself")
        watch = threading.Timer(self.serve.limit, lambda: (late.append(1), os.kill(copy, signal.SIGKILL)))
        watch.start()
        status = self.hear("q")[0]
        watch.cancel()
        return None if late else os.waitstatus_to_exitcode(status)

"""Runs commands that nobody means, each within limits of its own, and prints what they took."""
import contextlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

CODES = {0, 2, 3, 4, 5, 6, 7, 8, 9, 75, 130}
# Of a processor, with a mesh; bytes. All held in 15 s where this began; on a slower processor three take up to
# 24 s, by that build as well. What hangs takes minutes.
SECONDS, MEMORY = 30, 500e6

SCENE = """
frames = 1
[solver]
cell_size = 0.05
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
"""


class Attacks:
    """A folder for each of them; what does not hold is counted."""

    def __init__(self, program, kind, only):
        self.program, self.kind, self.only = str(pathlib.Path(program).resolve()), kind, only
        self.count, self.failed = 0, 0

    def wants(self, name):
        return not self.only or any(part in name for part in self.only)

    def run(self, name, files, *commands, seconds=SECONDS, memory=MEMORY, codes=CODES, before=None):
        """files: bytes, text, or a function that writes to a path, by name. Each command: words of neve,
        after the first with what the one before it left; before: a function of the folder."""
        if not self.wants(name):
            return
        folder = pathlib.Path(tempfile.mkdtemp(prefix="neve_attack_"))
        try:
            for file, content in files.items():
                path = folder / file
                path.parent.mkdir(parents=True, exist_ok=True)
                if callable(content):
                    content(path)
                else:
                    path.write_bytes(content.encode() if isinstance(content, str) else content)
            if before:
                before(folder)
            for command in commands:
                self._try(name, folder, command, seconds, memory, codes)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _try(self, name, folder, command, seconds, memory, codes):
        words = command.split() if isinstance(command, str) else list(command)
        told, said = folder / ".told", folder / ".said"
        with open(told, "wb") as out, open(said, "wb") as err:
            child = subprocess.Popen([self.program, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                     stderr=err, start_new_session=True, preexec_fn=lambda: limit(3 * seconds))
        timer = threading.Timer(10 * seconds + 60, lambda: os.killpg(child.pid, signal.SIGKILL))
        timer.start()
        _, status, usage = os.wait4(child.pid, 0)
        timer.cancel()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(status)
        took, peak = usage.ru_utime + usage.ru_stime, 1024.0 * usage.ru_maxrss
        words_out = told.read_bytes()[-20000:] + said.read_bytes()[-20000:]
        faults = []
        if code not in codes:
            faults.append(f"code {code}")
        if took > seconds:
            faults.append("slow")
        if peak > memory:
            faults.append("large")
        if any(c in words_out for c in b"\x07\x1b\x00\x08"):
            faults.append("control characters")
        if code not in (0, 130) and not said.read_bytes().strip() and not told.read_bytes().strip():
            faults.append("says nothing")
        self.count += 1
        self.failed += bool(faults)
        line = " ".join(said.read_text(errors="replace").split())
        print(f"{'FAIL' if faults else 'ok':4} {self.kind}: {name[:44]:44} {words[0]:8} code {code:3} {took:6.2f} s "
              f"{peak / 1e6:6.0f} MB  {'; '.join(faults)}{': ' if faults else ''}{line[:300 if faults else 90]}",
              flush=True)


def limit(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def stop(attacks):
    print(f"{attacks.kind}: {attacks.count} commands, {attacks.failed} failed")
    sys.exit(attacks.failed > 0)

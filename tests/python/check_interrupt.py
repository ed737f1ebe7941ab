"""Ctrl-C during neve.render. NEVE names the program.

    check_interrupt.py FOLDER_OF_neve.py
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time

module = sys.argv[1]
sys.path.insert(0, module)
import neve

script = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a test may have had it ignored
sys.path.insert(0, sys.argv[1])
import neve
try:
    neve.render("scene.toml", sys.argv[2], set={"frames": 100000})
except KeyboardInterrupt:
    print("interrupted")
"""


def interrupt(out, ask):
    """Interrupts a run that has begun. @return what Python said"""
    python = subprocess.Popen([sys.executable, "-B", "-c", script, module, out], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    try:
        for _ in range(1200):
            if pathlib.Path(out, "particles", "0003.png").exists():
                break
            time.sleep(0.05)
        ask(python.pid)
        return python.communicate(timeout=60)
    finally:
        if python.poll() is None:
            os.killpg(python.pid, signal.SIGKILL)


# A terminal interrupts Python and the program, others Python alone.
for out, ask in (("all", os.killpg), ("one", os.kill)):
    said = interrupt(out, lambda pid: ask(pid, signal.SIGINT))
    assert said == ("interrupted\n", ""), said
    run = neve.Run(out)
    assert run.status == "interrupted" and len(run.frames) > 3, run.status
    assert pathlib.Path(out, "particles.mp4").stat().st_size > 0
    assert not [file for file in pathlib.Path(out).rglob("*") if ".tmp" in file.name]

# Who asks the program alone hears how the run continues.
child = subprocess.Popen
def ended_child(*words, **more):
    started = child(*words, **more)
    while not pathlib.Path("alone", "particles", "0003.png").exists():
        time.sleep(0.05)
    started.send_signal(signal.SIGTERM)
    return started
subprocess.Popen = ended_child
try:
    neve.render("scene.toml", "alone", set={"frames": 100000})
    raise AssertionError("a run that was interrupted is no run that ended")
except neve.NeveError as error:
    assert error.code == 75 and error.answer["status"] == "interrupted", error.answer
    assert "interrupted; " in str(error) and 'flags=("--resume",) continues' in str(error), error
    assert not str(error).startswith("neve: "), error
print("same")

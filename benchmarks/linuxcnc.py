"""The time that is stated for a program, beside what LinuxCNC's simulation takes.

Samples are written for the machine `linuxcnc`, and run by LinuxCNC itself (package linuxcnc-uspace): its task
and its motion, without a screen, with the machine's speeds and accelerations, in real time, some minutes in
all (`python -m benchmarks linuxcnc`). Each program begins where the tool stands, as the stated time does.
LinuxCNC refuses to run as root.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from morfax.motion.pathfile import read_path
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import Machine, machine
from morfax.recorder.gcode.plan import Feeds

SAMPLES = Path(__file__).parents[1] / "samples"
PARTS = ("bracket", "cam", "curve", "gear", "program")
FEEDS_MM_MIN = (None, 2400.0)
LONGEST_S = 900.0

_HAL = """loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT base_period_nsec=0 servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=3
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net estop iocontrol.0.user-enable-out iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare iocontrol.0.tool-prepared
net change iocontrol.0.tool-change iocontrol.0.tool-changed
setp spindle.0.at-speed 1
"""
# runs in the place of a screen, by the system's own Python, which has LinuxCNC's module
_SCREEN = """#!/usr/bin/python3
import re, time, linuxcnc
from pathlib import Path
here = Path(__file__).parent
control, status = linuxcnc.command(), linuxcnc.stat()
def tell(what, *words):
    what(*words)
    control.wait_complete(60)
tell(control.state, linuxcnc.STATE_ESTOP_RESET)
tell(control.state, linuxcnc.STATE_ON)
tell(control.mode, linuxcnc.MODE_MANUAL)
for joint in range(3):
    tell(control.home, joint)
time.sleep(0.5)
for file in sorted(here.glob("*.ngc")):
    x, y = re.search(r"^G0 X(\\\\S+) Y(\\\\S+)", file.read_text(), re.M).groups()
    tell(control.mode, linuxcnc.MODE_MDI)
    tell(control.mdi, f"G90 G0 X{x} Y{y} Z0")
    tell(control.mode, linuxcnc.MODE_AUTO)
    tell(control.program_open, str(file))
    begun, runs = time.time(), False
    control.auto(linuxcnc.AUTO_RUN, 0)
    while not runs or status.interp_state != linuxcnc.INTERP_IDLE:
        time.sleep(0.005)
        status.poll()
        runs = runs or status.interp_state != linuxcnc.INTERP_IDLE
    with (here / "took").open("a") as took:
        print(file.stem, time.time() - begun, file=took)
"""


_INI = """\
[EMC]
VERSION = 1.1
[DISPLAY]
DISPLAY = {screen}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = sim.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = sim.tbl
[HAL]
HALFILE = sim.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = {fastest}
DEFAULT_LINEAR_ACCELERATION = {most}
NO_FORCE_HOMING = 1
[KINS]
KINEMATICS = trivkins
JOINTS = 3
"""


def configuration(folder: Path, wanted: Machine) -> Path:
    """Write a simulated machine with the speeds and accelerations of ours; its .ini file."""
    (folder / "sim.hal").write_text(_HAL)
    (folder / "sim.tbl").touch()
    (folder / "sim.var").touch()
    screen = folder / "screen.py"
    screen.write_text(_SCREEN.replace("\\\\", "\\"))
    screen.chmod(0o755)
    fastest, most = max(wanted.rapid_mm_s), max(wanted.acceleration_mm_s2)
    text = _INI.format(screen=screen, fastest=2 * fastest, most=most)
    for number, letter in enumerate("XYZ"):
        limits = (
            f"MAX_VELOCITY = {wanted.rapid_mm_s[number]}\n"
            f"MAX_ACCELERATION = {wanted.acceleration_mm_s2[number]}\n"
            "MIN_LIMIT = -1000\nMAX_LIMIT = 1000\n"
        )
        text += f"[AXIS_{letter}]\n{limits}[JOINT_{number}]\nTYPE = LINEAR\n{limits}"
        text += "HOME_SEQUENCE = 0\nHOME_SEARCH_VEL = 0\nHOME_LATCH_VEL = 0\n"
    ini = folder / "sim.ini"
    ini.write_text(text)
    return ini


def main(words: list[str]) -> None:
    """Write the programs, run them, and print both times."""
    if words or shutil.which("linuxcnc") is None or os.getuid() == 0:
        sys.exit(
            "linuxcnc takes no words, wants LinuxCNC (package linuxcnc-uspace), and runs as a user that is "
            "not root"
        )
    with tempfile.TemporaryDirectory() as name:
        folder, stated = Path(name), dict[str, float]()
        for part in PARTS:
            for feed in FEEDS_MM_MIN:
                file = folder / f"{part}-{feed or 0:g}.ngc"
                path = read_path(SAMPLES / f"{part}.csv")
                report = record_blocks(path, file, feeds=Feeds(feed / 60 if feed else None))
                stated[file.stem] = report.duration_s
        ini = configuration(folder, machine())
        subprocess.run(
            ["linuxcnc", str(ini)], timeout=LONGEST_S, check=False, capture_output=True
        )
        took = re.findall(r"(\S+) (\S+)", (folder / "took").read_text())
        print(f"{'program':<14} {'stated s':>9} {'taken s':>9} {'short':>6}")
        for part, seconds in took:
            share = 1 - stated[part] / float(seconds)
            print(f"{part:<14} {stated[part]:>9.2f} {float(seconds):>9.2f} {share:>6.1%}")

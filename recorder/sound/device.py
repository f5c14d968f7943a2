"""Sound devices: which there are, and what goes wrong with them.

Signals: names in; devices out, as PortAudio lists them. The tape goes out to one by `device_sink`, and comes
in from one by `device_source`; the device keeps time.

A sample that is left out or put in would be a wrong place on the work, so an underrun, an overrun and a
device that stops are faults.

Source: PortAudio V19, by way of sounddevice, the extra `morfax[sound]`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType

from morfax.motion.faults import DeviceFault

STOPPED_S = 5.0  # without a callback: the device has stopped

_INSTALL = 'sound devices need sounddevice; install it with: pip install "morfax[sound]"'
_NO_PORTAUDIO = (
    "sound devices need the PortAudio library, which is not there; install it (Debian: apt install "
    "libportaudio2)"
)


@dataclass(frozen=True, slots=True)
class Device:
    """A sound device as PortAudio lists it: number, name, host interface, tracks in and out, usual rate."""

    number: int
    name: str
    host: str
    inputs: int
    outputs: int
    rate_hz: int


def devices() -> list[Device]:
    """All sound devices of this machine; raises DeviceFault where sounddevice or PortAudio is missing."""
    portaudio = sounddevice()
    hosts = [host["name"] for host in portaudio.query_hostapis()]
    return [
        Device(
            number,
            str(each["name"]),
            str(hosts[each["hostapi"]]),
            int(each["max_input_channels"]),
            int(each["max_output_channels"]),
            round(each["default_samplerate"]),
        )
        for number, each in enumerate(portaudio.query_devices())
    ]


def found(name: str, *, tracks: int, is_input: bool) -> Device:
    """The device of a number, a name or a part of one, with enough tracks; raises DeviceFault."""
    every = devices()
    fitting = [each for each in every if name in (str(each.number), each.name)] or [
        each for each in every if name.casefold() in f"{each.name}, {each.host}".casefold()
    ]
    if not fitting:
        raise DeviceFault(
            f"there is no sound device {name!r}; morfax devices lists those that are there",
            device=name,
        )
    way = "inputs" if is_input else "outputs"
    wide = [each for each in fitting if getattr(each, way) >= tracks]
    if not wide:
        has = getattr(fitting[0], way)
        raise DeviceFault(
            f"the device {fitting[0].name!r} has {has} {way}; this tape has {tracks} tracks: take a device "
            "with as many, or two stereo files (--stereo)",
            device=name,
        )
    if len(wide) > 1:
        names = ", ".join(f"{each.number} {each.name!r}" for each in wide)
        raise DeviceFault(f"{name!r} may be {names}; give the number", device=name)
    return wide[0]


def rate_for(device: Device, wanted_hz: int, *, tracks: int, is_input: bool) -> int:
    """The wanted rate if the device has it, else the device's own, Hz."""
    portaudio = sounddevice()
    check = portaudio.check_input_settings if is_input else portaudio.check_output_settings
    try:
        check(device=device.number, channels=tracks, dtype="float32", samplerate=wanted_hz)
    except portaudio.PortAudioError:
        return device.rate_hz
    return wanted_hz


@contextmanager
def as_faults(device: Device) -> Iterator[None]:
    """Turn an error of PortAudio into a DeviceFault."""
    try:
        yield
    except sounddevice().PortAudioError as error:
        raise DeviceFault(
            f"the device {device.name!r} cannot be used: {error}; morfax devices lists the others",
            device=device.name,
        ) from error


def sounddevice() -> ModuleType:
    """sounddevice; raises DeviceFault that says what to install."""
    try:
        import sounddevice
    except ImportError:
        raise DeviceFault(_INSTALL) from None
    except OSError:
        raise DeviceFault(_NO_PORTAUDIO) from None
    module: ModuleType = sounddevice
    return module

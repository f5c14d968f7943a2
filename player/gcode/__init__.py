"""The pulse control: RS-274 lines and arcs drive pulse servos (Pratt & Whitney 1967, US application 631 214).

It asks motion/ and player/monitor. Jobs ask `pulses.play_pulses` and `held_speed`.
"""

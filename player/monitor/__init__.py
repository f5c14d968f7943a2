"""The following-error monitor that watches every control (Alfred Herbert 1972, patent ES 414458).

It asks motion/ only. All controls ask `monitor`; jobs and reports ask `chart`.
"""

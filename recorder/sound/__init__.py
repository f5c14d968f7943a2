"""Sound in and out: files, pipes and sound devices, each behind one kind of source and one kind of sink.

It asks motion/ only, and knows nothing of a tape's format. The tape asks `source.Source` and `source.Sink`;
jobs ask `source.FileSource`, `pipe.PipeSource`, `pipe.PipeSink`, `device.DeviceSource`, `device.DeviceSink`.
"""

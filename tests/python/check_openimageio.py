"""Reads a picture with passes by OpenImageIO and compares it with the reader of this folder, which was
written after the description of the format: names and types of all channels, and all numbers to the bit.

    check_openimageio.py FILE.exr
"""

import sys

import numpy as np
import OpenImageIO as oiio

from read_exr import read_exr

path = sys.argv[1]
_, _, planes = read_exr(path)
picture = oiio.ImageInput.open(path)
assert picture, oiio.geterror()
spec = picture.spec()
assert sorted(spec.channelnames) == sorted(planes), (spec.channelnames, sorted(planes))
assert not picture.seek_subimage(1, 0), "one part holds all channels"
types = spec.channelformats or [spec.format] * spec.nchannels
numbers = picture.read_image(0, spec.nchannels, oiio.FLOAT)
assert numbers.shape == (spec.height, spec.width, spec.nchannels), numbers.shape
for at, name in enumerate(spec.channelnames):
    ours = planes[name]
    assert str(types[at]) == {"float16": "half", "float32": "float"}[ours.dtype.name], (name, types[at])
    same = numbers[:, :, at].astype("f4").tobytes() == np.ascontiguousarray(ours, "f4").tobytes()
    assert same, f"{name} differs"
for name in ("neve:scene", "neve:state_hash", "worldToCamera", "worldToNDC", "framesPerSecond"):
    assert spec.getattribute(name) is not None, name
print("same", spec.nchannels)

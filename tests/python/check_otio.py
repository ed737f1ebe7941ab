"""The timeline of a sweep as opentimelineio reads it.

    check_otio.py FOLDER_OF_SWEEP
"""

import os
import sys

import opentimelineio as otio

folder = sys.argv[1]
timeline = otio.adapters.read_from_file(f"{folder}/runs.otio")
clips = list(timeline.find_clips())
assert len(clips) == 2, clips
for index, clip in enumerate(clips):
    media = clip.media_reference
    assert isinstance(media, otio.schema.ImageSequenceReference), media
    assert media.number_of_images_in_sequence() == 3, media
    for image in range(3):
        url = media.target_url_for_image_number(image)
        assert url == f"review/run_{index:04d}.{1000 + image}.png", url
        assert os.path.isfile(f"{folder}/{url}"), url
    assert clip.source_range.duration == otio.opentime.RationalTime(3, 24)
    assert clip.source_range.start_time == otio.opentime.RationalTime(1000, 24)
    (marker,) = clip.markers
    value = (5, 10)[index]
    assert marker.name == f"material.snow.hardening = {value}", marker.name
    assert marker.metadata["neve"]["value"] == value
    assert clip.metadata["neve"]["state"] == "ok"
    assert clip.metadata["neve"]["metrics"]["steps"] > 0
assert timeline.duration() == otio.opentime.RationalTime(6, 24)
print("same")

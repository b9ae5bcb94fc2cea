#!/usr/bin/python3
"""Joins FOLDER/frame-*.png to an animated GIF of at most 4 MB, ten frames a second.

Usage: join-frames.py FOLDER FILE.gif
"""
import pathlib
import sys

from PIL import Image, ImageChops

FRAME_MS = 100
LAST_FRAME_MS = 3000  # before it begins again
LARGEST_BYTES = 4_000_000
UNSEEN_CHANGE = 6  # of 255: a colour that changes less stays as it is, which takes no room
TRANSPARENT = 255  # the last of 256 colours


def only_changes(frames: list[Image.Image], colours: list[Image.Image]) -> list[Image.Image]:
    """The frames in the palette's colours, transparent where they show what stands there already."""
    shown, result = frames[0], colours[:1]
    for frame, coloured in zip(frames[1:], colours[1:]):
        red, green, blue = ImageChops.difference(shown, frame).split()
        change = ImageChops.lighter(red, ImageChops.lighter(green, blue))
        changed = change.point(lambda value: 255 if value > UNSEEN_CHANGE else 0)
        shown = Image.composite(frame, shown, changed)
        image = Image.new("P", frame.size, TRANSPARENT)
        image.putpalette(colours[0].getpalette())
        image.paste(coloured, mask=changed)
        result.append(image)
    return result


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    folder, film = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    files = sorted(folder.glob("frame-*.png"))
    if not files:
        sys.exit(f"{folder}: no frame-*.png; depthgrid-lab experiment film --out {folder} writes them")
    frames = [Image.open(file).convert("RGB") for file in files]
    # One palette for all, of the colours of several instants, so that what stands still stays the same.
    sample = Image.new("RGB", (frames[0].width, 6 * frames[0].height))
    for i in range(6):
        sample.paste(frames[i * (len(frames) - 1) // 5], (0, i * frames[0].height))
    # Large areas shade finely, and small things keep their own colours.
    shades = sample.quantize(colors=175, method=Image.Quantize.MEDIANCUT).getpalette()[: 3 * 175]
    others = sample.quantize(colors=TRANSPARENT - 175, method=Image.Quantize.MAXCOVERAGE).getpalette()
    palette = Image.new("P", (1, 1))
    palette.putpalette((shades + others)[: 3 * TRANSPARENT])
    images = only_changes(frames, [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames])
    durations = [FRAME_MS] * (len(images) - 1) + [LAST_FRAME_MS]
    part = film.with_name(film.name + ".part")
    images[0].save(part, format="GIF", save_all=True, append_images=images[1:], duration=durations, loop=0, optimize=False,
                   transparency=TRANSPARENT, disposal=1)
    size = part.stat().st_size
    if size > LARGEST_BYTES:
        part.unlink()
        sys.exit(f"{film}: {size / 1e6:.1f} MB, more than {LARGEST_BYTES / 1e6:.0f}; fewer frames (--frames) or colours")
    part.rename(film)
    print(f"{film}: {len(images)} frames, {size / 1e6:.1f} MB")


main()

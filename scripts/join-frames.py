#!/usr/bin/env python3
"""Joins FOLDER/frame-*.png to an animated GIF of at most 4 MB, ten frames a second.

Usage: join-frames.py FOLDER FILE.gif
"""
import pathlib
import sys

from PIL import Image

FRAME_MS = 100
LAST_FRAME_MS = 3000  # before it begins again
LARGEST_BYTES = 4_000_000


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
    palette = sample.quantize(colors=64, method=Image.Quantize.MEDIANCUT)
    images = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    durations = [FRAME_MS] * (len(images) - 1) + [LAST_FRAME_MS]
    part = film.with_name(film.name + ".part")
    images[0].save(part, format="GIF", save_all=True, append_images=images[1:], duration=durations, loop=0, optimize=False)
    size = part.stat().st_size
    if size > LARGEST_BYTES:
        part.unlink()
        sys.exit(f"{film}: {size / 1e6:.1f} MB, more than {LARGEST_BYTES / 1e6:.0f}; fewer frames (--frames) or colours")
    part.rename(film)
    print(f"{film}: {len(images)} frames, {size / 1e6:.1f} MB")


main()

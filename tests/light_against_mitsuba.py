#!/usr/bin/env python3
"""Compares hitscope's pictures of light with those of Mitsuba 3 for the same scene files.

    pip install mitsuba==3.9.1          # 63 MB, so neither `cargo test` nor CI runs this script
    cargo build --release
    tests/light_against_mitsuba.py [--binary HITSCOPE] [--samples N] [SCENE.xml]...

The binary is by default $HITSCOPE, else target/release/hitscope; the scenes, tests/scenes/light_*.xml.

Both programs render with N samples per pixel (1024), Mitsuba in 16 parts with different seeds, whose spread gives its
standard error; hitscope writes its own into the picture. A pixel passes if the luminances differ by less than the
quantile of the normal distribution that one picture in 100 exceeds in any pixel (Šidák's correction). At least 99.75 %
must pass.

Source of the test: Subr, Arvo, "Statistical Hypothesis Testing for Assessing Monte Carlo Estimators", Pacific Graphics
2007.

Prints the samples per second of CPU time, too. The exit status is 1 if a scene fails.
"""
import argparse
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

PASSING = 0.9975
PARTS = 16
TESTS = pathlib.Path(__file__).resolve().parent
BINARY = os.environ.get("HITSCOPE", TESTS.parent / "target" / "release" / "hitscope")
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def hitscope_picture(binary, path, samples):
    """Luminance, its standard error, and CPU time in seconds."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.exr"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [binary, "render", path, "-o", out, "--view", "path", "--samples", str(samples)]
        subprocess.run(command, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        bitmap = mi.Bitmap(str(out))
    pixels = np.array(bitmap).astype(float)
    channel = {field.name: pixels[..., k] for k, field in enumerate(bitmap.struct_())}
    colour = np.stack([channel[name] for name in "RGB"], axis=-1)
    error = np.sqrt(channel["variance"])
    return colour @ LUMINANCE, error, seconds


def mitsuba_picture(path, samples):
    scene = mi.load_file(str(path))
    start = time.process_time()
    parts = [
        np.array(mi.render(scene, spp=max(samples // PARTS, 1), seed=seed))[..., :3] @ LUMINANCE
        for seed in range(PARTS)
    ]
    seconds = time.process_time() - start
    parts = np.stack(parts)
    return parts.mean(axis=0), parts.std(axis=0, ddof=1) / np.sqrt(PARTS), seconds


def compare(binary, path, samples):
    ours, our_error, our_seconds = hitscope_picture(binary, path, samples)
    theirs, their_error, their_seconds = mitsuba_picture(path, samples)
    n = ours.size
    level = 1.0 - (1.0 - 0.01) ** (1.0 / n)
    limit = statistics.NormalDist().inv_cdf(1.0 - level / 2.0)
    # Both programs compute in f32; black pixels have no error.
    error = np.sqrt(our_error**2 + their_error**2) + 1e-5 * theirs + 1e-9
    z = np.abs(ours - theirs) / error
    passing = float(np.mean(~(z > limit)))
    bias = float(ours.mean() / theirs.mean() - 1.0)
    rate = lambda seconds: n * samples / seconds / 1e6
    print(
        f"{path.name}: {100 * passing:.2f} % of {n} pixels pass (|z| < {limit:.2f}; largest {z.max():.1f}), "
        f"means differ by {100 * bias:+.3f} %, Msamples/s of CPU time {rate(our_seconds):.2f} "
        f"and Mitsuba's {rate(their_seconds):.2f}"
    )
    return passing >= PASSING


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--binary", default=BINARY)
    parser.add_argument("--samples", type=int, default=1024)
    arguments = parser.parse_args()
    mi.set_variant("scalar_rgb")
    scenes = arguments.scenes or sorted((TESTS / "scenes").glob("light_*.xml"))
    passed = [compare(arguments.binary, scene, arguments.samples) for scene in scenes]
    sys.exit(0 if all(passed) else 1)


if __name__ == "__main__":
    main()

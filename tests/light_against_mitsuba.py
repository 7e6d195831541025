#!/usr/bin/env python3
"""Compares hitscope's pictures of light with those of Mitsuba 3 for the same scene files.

    pip install mitsuba==3.9.1          # 63 MB, so neither `cargo test` nor CI runs this script
    cargo build --release
    tests/light_against_mitsuba.py [--binary HITSCOPE] [--samples N] [--mesh MESH.obj] [SCENE.xml]...

The binary is by default $HITSCOPE, else target/release/hitscope; the scenes, tests/scenes/light_*.xml. The mesh is that
of light_mesh.xml, with the y axis up, and is scaled to the scene; by default, it is a knot.

Both programs render with N samples per pixel (1024), Mitsuba in 16 parts with different seeds, whose spread gives its
standard error; hitscope writes its own into the picture. A pixel passes if the luminances differ by less than the
quantile of the normal distribution that one picture in 100 exceeds in any pixel (Šidák's correction). At least 99.75 %
must pass.

Source of the test: Subr, Arvo, "Statistical Hypothesis Testing for Assessing Monte Carlo Estimators", Pacific Graphics
2007.

Prints the samples per second of CPU time, too. The exit status is 1 if a scene fails.
"""
import argparse
import math
import os
import pathlib
import re
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


def write_knot(path):
    """A tube along a trefoil knot, made of triangles."""
    along, around, radius = 160, 16, 0.35
    centres = []
    for k in range(along):
        t = 2 * math.pi * k / along
        ring = 2 + math.cos(3 * t)
        centres.append(np.array([ring * math.cos(2 * t), ring * math.sin(2 * t), math.sin(3 * t)]))
    lines = []
    for k, centre in enumerate(centres):
        tangent = centres[(k + 1) % along] - centres[k - 1]
        # The centre is never along the tangent.
        side = np.cross(tangent, centre)
        side /= np.linalg.norm(side)
        up = np.cross(side, tangent)
        up /= np.linalg.norm(up)
        for j in range(around):
            angle = 2 * math.pi * j / around
            x, y, z = centre + radius * (math.cos(angle) * side + math.sin(angle) * up)
            lines.append(f"v {x:.6f} {y:.6f} {z:.6f}")
    index = lambda k, j: k % along * around + j % around + 1
    for k in range(along):
        for j in range(around):
            a, b, c, d = index(k, j), index(k, j + 1), index(k + 1, j + 1), index(k + 1, j)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    path.write_text("\n".join(lines) + "\n")


def with_mesh(scene, mesh, folder):
    """A copy of a scene with a mesh that stands in its middle, 1.6 units high."""
    vertices = [line.split()[1:4] for line in mesh.read_text().splitlines() if line.startswith("v ")]
    low, high = (f(np.array(vertices, dtype=float), axis=0) for f in (np.min, np.max))
    middle = (low + high) / 2
    values = {
        "mesh": mesh.resolve(),
        "x": -middle[0],
        "y": -low[1],
        "z": -middle[2],
        "scale": 1.6 / (high[1] - low[1]),
        "sky": (TESTS.parent / "assets" / "studio.hdr").resolve(),
    }
    text = scene.read_text()
    for name, value in values.items():
        text = re.sub(rf'(<default name="{name}" value=")[^"]*', lambda found: f"{found[1]}{value}", text)
    path = pathlib.Path(folder) / scene.name
    path.write_text(text)
    return path


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
    bias_error = float(np.sqrt(np.sum(our_error**2 + their_error**2)) / n / theirs.mean())
    rate = lambda seconds: n * samples / seconds / 1e6
    print(
        f"{path.name}: {100 * passing:.2f} % of {n} pixels pass (|z| < {limit:.2f}; largest {z.max():.1f}), "
        f"means differ by {100 * bias:+.3f} % (standard error {100 * bias_error:.3f} %), Msamples/s of CPU time {rate(our_seconds):.2f} "
        f"and Mitsuba's {rate(their_seconds):.2f}"
    )
    return passing >= PASSING


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--binary", default=BINARY)
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--mesh", type=pathlib.Path)
    arguments = parser.parse_args()
    mi.set_variant("scalar_rgb")
    scenes = arguments.scenes or sorted((TESTS / "scenes").glob("light_*.xml"))
    with tempfile.TemporaryDirectory() as folder:
        mesh = arguments.mesh
        if mesh is None:
            mesh = pathlib.Path(folder) / "knot.obj"
            write_knot(mesh)
        has_mesh = lambda scene: 'name="mesh"' in scene.read_text()
        scenes = [with_mesh(scene, mesh, folder) if has_mesh(scene) else scene for scene in scenes]
        passed = [compare(arguments.binary, scene, arguments.samples) for scene in scenes]
    sys.exit(0 if all(passed) else 1)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares hitscope's hits with those of Mitsuba 3 for the same scene files and the same rays.

    pip install mitsuba==3.9.1          # 63 MB, so neither `cargo test` nor CI runs this script
    cargo build --release
    tests/against_mitsuba.py [--binary HITSCOPE] [--kernel KERNEL]... [SCENE.xml]...

The binary is by default $HITSCOPE, else target/release/hitscope; the scenes, perspective.xml and orthographic.xml of
tests/scenes; the kernels, watertight and exact.

Mitsuba's sensor makes the ray through the centre of each pixel, in f32. Both programs trace it. A pixel differs if
only one of them finds a hit, if t differs by more than 1e-5 relatively, or if the geometric normals differ by more
than 1e-4. Pixels within one pixel of a silhouette are counted apart: one of their eight neighbours shows another shape
or nothing, or a point of the same shape that isn't on the same piece of surface: the distances of each point from the
tangent plane at the other are larger than the distance between the rays there. For some pixels, hitscope's own camera
is compared, too: its ray must pass within 0.01 pixels of Mitsuba's at a distance of 8.

The exit status is 1 if the cameras differ, or if any pixel differs elsewhere than at a silhouette.

Result of 2026-11: of 720896 pixels, none differs elsewhere. At silhouettes, 2 differ with the kernel `exact`, 24 with
`watertight`. With `exact`, one ray passes the edge of a triangle at a distance of 2e-8: for the vertices, which are the
same f32 numbers in both programs, exact arithmetic finds a miss as hitscope does, while Mitsuba finds a hit. The other
grazes the thin cylinder, where rounding its parameters to f32 matters. With `watertight`, all others graze the
cylinders or the shell: a few ulps of t, at a distance of 300 radii, turn the normal by 1e-4.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

import mitsuba as mi
import numpy as np

T_BAR = 1e-5
NORMAL_BAR = 1e-4
CAMERA_BAR = 0.01
TESTS = pathlib.Path(__file__).resolve().parent
SCENES = [TESTS / "scenes" / name for name in ("perspective.xml", "orthographic.xml")]
BINARY = os.environ.get("HITSCOPE", TESTS.parent / "target" / "release" / "hitscope")


class Hits:
    """The hits of a picture's rays: t, infinite for a miss; the geometric normal; and the shape, −1 for a miss."""

    def __init__(self, height, width):
        self.t = np.full((height, width), np.inf)
        self.normal = np.zeros((height, width, 3))
        self.shape = np.full((height, width), -1)


def mitsuba_rays(sensor):
    """The ray of each pixel: origin, direction, and the largest t."""
    width, height = sensor.film().size()
    rays = np.empty((height, width, 7))
    middle = mi.Point2f(0.5, 0.5)
    for y, x in np.ndindex(height, width):
        at = mi.Point2f((x + 0.5) / width, (y + 0.5) / height)
        ray, _ = sensor.sample_ray(0, 0.5, at, middle)
        rays[y, x] = *ray.o, *ray.d, ray.maxt
    return rays


def mitsuba_hits(scene, rays):
    hits = Hits(*rays.shape[:2])
    numbers = {}
    for at in np.ndindex(*hits.t.shape):
        *o, dx, dy, dz, maxt = rays[at]
        ray = mi.Ray3f(mi.Point3f(*o), mi.Vector3f(dx, dy, dz), maxt, 0.0, [])
        found = scene.ray_intersect(ray)
        if found.is_valid():
            hits.t[at] = found.t
            hits.normal[at] = found.n
            hits.shape[at] = numbers.setdefault(found.shape.id(), len(numbers))
    return hits


def hitscope_hits(binary, path, kernel, rays):
    """The hits by `hitscope trace`, and the largest rounding of a ray."""
    hits = Hits(*rays.shape[:2])
    lines = (" ".join(map(repr, ray[:6].tolist())) + f" 0 {float(ray[6])!r}\n" for ray in rays.reshape(-1, 7))
    command = [binary, "trace", path, "--rays", "-", "--kernel", kernel]
    output = subprocess.run(command, input="".join(lines), check=True, stdout=subprocess.PIPE, text=True).stdout
    answers = [json.loads(line) for line in output.splitlines()]
    assert len(answers) == hits.t.size, f"{len(answers)} answers to {hits.t.size} rays"
    for at, answer in zip(np.ndindex(*hits.t.shape), answers):
        if answer["hit"]:
            hits.t[at] = answer["t"]
            hits.normal[at] = answer["normal"]
    return hits, max(answer["ray_rounding"] for answer in answers)


def at_silhouettes(hits, rays):
    """Whether one of a pixel's eight neighbours shows another shape, nothing, or another piece of surface."""
    height, width = hits.t.shape
    found = np.zeros((height, width), dtype=bool)
    origin, direction = rays[..., :3], rays[..., 3:6]
    t = np.where(np.isfinite(hits.t), hits.t, 0)[..., None]
    point = origin + t * direction
    for dy, dx in ((0, 1), (1, -1), (1, 0), (1, 1)):
        # Two views of the picture: `a` has each pixel, `b` its neighbour.
        a = np.s_[:height - dy, max(0, -dx):width - max(0, dx)]
        b = np.s_[dy:, max(0, dx):width - max(0, -dx)]
        between = point[b] - point[a]
        from_planes = np.minimum(*(np.abs(np.sum(hits.normal[at] * between, axis=2)) for at in (a, b)))
        of_rays = np.linalg.norm(origin[b] + t[a] * direction[b] - point[a], axis=2)
        differs = (hits.shape[a] != hits.shape[b]) | (from_planes > of_rays)
        found[a] |= differs
        found[b] |= differs
    return found


def compared(theirs, ours, silhouettes):
    """Prints how many pixels differ; returns whether all of them lie at silhouettes."""
    both = np.isfinite(theirs.t) & np.isfinite(ours.t)
    with np.errstate(invalid="ignore"):
        t_error = np.where(both, np.abs(ours.t - theirs.t) / theirs.t, 0)
    normal_error = np.where(both, np.linalg.norm(ours.normal - theirs.normal, axis=2), 0)
    kinds = [
        ("hit or miss", np.isfinite(theirs.t) != np.isfinite(ours.t)),
        ("t", t_error > T_BAR),
        ("normal", normal_error > NORMAL_BAR),
    ]
    for kind, differs in kinds + [("any", np.any([differs for _, differs in kinds], axis=0))]:
        inside = differs & ~silhouettes
        print(f"    {kind + ':':12} {np.sum(differs & silhouettes):5} at silhouettes, {np.sum(inside):5} elsewhere")
    for name, error in (("t", t_error), ("normal", normal_error)):
        print(f"    largest difference of {name} elsewhere: {np.max(error, where=~silhouettes, initial=0):.2g}")
    for y, x in np.argwhere(inside)[:10]:
        print(f"    pixel {x},{y}: t {theirs.t[y, x]:.9g}, here {ours.t[y, x]:.9g}; "
              f"normal {theirs.normal[y, x]}, here {ours.normal[y, x]}")
    return not inside.any()


def same_camera(binary, path, rays):
    """Compares hitscope's camera for some pixels, among them the corners."""
    height, width = rays.shape[:2]
    largest = 0
    places = [(x, y) for y in np.linspace(0, height - 1, 6, dtype=int) for x in np.linspace(0, width - 1, 8, dtype=int)]
    for x, y in places:
        command = [binary, "inspect", path, "--json", "--pixel", f"{x},{y}", "--size", f"{width}x{height}"]
        ray = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)["ray"]
        origin, direction = np.array(ray["origin"]), np.array(ray["direction"])
        # Both rays at a distance at which much of the scene lies.
        point, neighbour = (o + 8 * d for o, d in (np.split(rays[y, at, :6], 2) for at in (x, x + 1 if x == 0 else x - 1)))
        beside = np.linalg.norm(np.cross(point - origin, direction)) / np.linalg.norm(direction)
        largest = max(largest, beside / np.linalg.norm(point - neighbour))
    print(f"  camera: rays of {len(places)} pixels differ by at most {largest:.2g} pixels")
    return largest <= CAMERA_BAR


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=BINARY)
    parser.add_argument("--kernel", action="append")
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE.xml")
    arguments = parser.parse_args()
    mi.set_variant("scalar_rgb")
    is_good = True
    for path in arguments.scenes:
        # Otherwise, Mitsuba merges meshes, and silhouettes between them are lost.
        scene = mi.load_file(str(path), optimize=False)
        rays = mitsuba_rays(scene.sensors()[0])
        theirs = mitsuba_hits(scene, rays)
        silhouettes = at_silhouettes(theirs, rays)
        print(f"{path}: {theirs.t.size} pixels, {np.isfinite(theirs.t).sum()} hits, {theirs.shape.max() + 1} shapes, "
              f"{silhouettes.sum()} pixels at silhouettes")
        is_good &= same_camera(arguments.binary, path, rays)
        for kernel in arguments.kernel or ["watertight", "exact"]:
            ours, rounding = hitscope_hits(arguments.binary, path, kernel, rays)
            print(f"  {kernel}: rays rounded by at most {rounding:.2g}; pixels that differ from Mitsuba's:")
            is_good &= compared(theirs, ours, silhouettes)
    sys.exit(not is_good)


if __name__ == "__main__":
    main()

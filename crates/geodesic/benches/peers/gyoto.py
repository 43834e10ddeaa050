#!/usr/bin/env python3
"""Gyoto on the second task of benches/geodesics.rs: Kerr a = 0.9, camera at r = 1000 M and 60 degrees from the
axis, 32 x 32 rays within 0.02 rad, to the first crossing of a thin disc from 2.4 M to 40 M.

    python3 crates/geodesic/benches/peers/gyoto.py        (Debian: apt install gyoto-bin)

Times are processor time of one thread, less that of a picture of one ray. Errors are of the radius of the hit,
against Gyoto's own rays with tolerances of 1e-12 and steps of at most 0.1 M.
"""

import array
import math
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

SCENE = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<Scenery>
  <Metric kind="KerrBL"><Mass unit="sunmass">4e6</Mass><Spin>0.9</Spin></Metric>
  <Screen>
    <Position>1000 1000 {theta} 0</Position>
    <FieldOfView unit="radian">0.02</FieldOfView>
    <Resolution>{side}</Resolution>
  </Screen>
  <Astrobj kind="ThinDisk">
    <InnerRadius>2.4</InnerRadius><OuterRadius>40</OuterRadius><RMax>{rmax}</RMax>
  </Astrobj>
  {options}
  <Quantities>EmissionTime</Quantities>
</Scenery>
"""


def options(integrator, tolerance, over_r, longest="1e6", first="100"):
    return (
        f"<Integrator>{integrator}</Integrator><AbsTol>{tolerance}</AbsTol><RelTol>{tolerance}</RelTol>"
        f"<DeltaMax>{longest}</DeltaMax><DeltaMaxOverR>{over_r}</DeltaMaxOverR><Delta>{first}</Delta>"
    )


def last_image(path):
    """The numbers of a FITS file's last image: 16 a pixel, coordinates at the hit."""
    data, at, numbers = path.read_bytes(), 0, None
    while at < len(data):
        header, ended = {}, False
        while not ended:
            for card in range(0, 2880, 80):
                text = data[at + card : at + card + 80].decode("latin1")
                ended = ended or text.startswith("END ")
                if text[8:9] == "=":
                    header[text[:8].strip()] = text[10:].split("/")[0].strip()
            at += 2880
        size = math.prod(int(header[f"NAXIS{i + 1}"]) for i in range(int(header["NAXIS"])))
        size *= 1 if header["NAXIS"] != "0" else 0
        length = size * abs(int(header["BITPIX"])) // 8
        if size:
            numbers = array.array("d", data[at : at + length])
            if sys.byteorder == "little":
                numbers.byteswap()
        at += -(-length // 2880) * 2880
    return numbers


def trace(folder, side, extra, rmax):
    """Seconds of processor time, and the radius of each hit (huge where there is none)."""
    scene, picture = folder / "scene.xml", folder / "picture.fits"
    scene.write_text(SCENE.format(theta=math.pi / 3, side=side, rmax=rmax, options=extra))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = ["gyoto", "-T1", str(scene), "!" + str(picture), "--impact-coords"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if not re.search(r"Raytraced", done.stdout):
        sys.exit(f"gyoto failed: {done.stdout[-300:]} {done.stderr[-300:]}")
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return seconds, list(last_image(picture)[1::16])


def main():
    side = 32
    ways = [
        ("default", "", "1000"),
        ("fehlberg78 1e-6", options("runge_kutta_fehlberg78", "1e-6", "0.3"), "60"),
        ("fehlberg78 1e-8", options("runge_kutta_fehlberg78", "1e-8", "1"), "41"),
        ("cash_karp54 1e-8", options("runge_kutta_cash_karp54", "1e-8", "1"), "41"),
        ("cash_karp54 1e-10", options("runge_kutta_cash_karp54", "1e-10", "1"), "41"),
        ("dopri5 1e-10", options("runge_kutta_dopri5", "1e-10", "1"), "41"),
    ]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        _, exact = trace(folder, side, options("runge_kutta_fehlberg78", "1e-12", "1", "0.1", "0.1"), "1000")
        print("| way | ms a ray | median error, of r | 99 % | worst | hits |\n|---|---|---|---|---|---|")
        for title, extra, rmax in ways:
            idle = min(trace(folder, 1, extra, rmax)[0] for _ in range(3))
            runs = [trace(folder, side, extra, rmax) for _ in range(1 if not extra else 3)]
            seconds = min(run[0] for run in runs) - idle
            errors = sorted(abs(a / b - 1) for a, b in zip(runs[0][1], exact) if a < 1e300 and b < 1e300)
            at = lambda part: errors[int((len(errors) - 1) * part)]
            print(
                f"| {title} | {1e3 * seconds / side**2:.3f} | {at(0.5):.1e} | {at(0.99):.1e} | {at(1):.1e} "
                f"| {len(errors)} |",
                flush=True,
            )


if __name__ == "__main__":
    main()

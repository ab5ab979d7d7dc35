"""What every exporter is called with, and what it answers.

    to_NAME.py SCENE --spp N --seed S --threads T -o PICTURE --report REPORT

PICTURE is linear radiance (.exr). REPORT is JSON: the renderer's version, the seconds of `loading` (the renderer's own calls that
make the scene and build its trees; not the import of its module, and not what the exporter does before, which a scene in the
renderer's own format would not need) and of `rendering`, and the `spp` that were taken in fact.
"""

import argparse
import json
import time
from pathlib import Path


class Job:
    def __init__(self):
        parser = argparse.ArgumentParser()
        parser.add_argument("scene", type=Path)
        parser.add_argument("--spp", type=int, required=True)
        parser.add_argument("--seed", type=int, required=True)
        parser.add_argument("--threads", type=int, required=True)
        parser.add_argument("-o", "--output", type=Path, required=True)
        parser.add_argument("--report", type=Path, required=True)
        self.__dict__.update(vars(parser.parse_args()))
        self.start = self.loading = None

    def begin(self):
        """The renderer begins to load."""
        self.start = time.perf_counter()

    def loaded(self):
        """Rendering begins."""
        self.loading = time.perf_counter() - self.start

    def rendered(self, version, spp, rendering=None):
        """The picture is done. `rendering` is how long was rendered, where the program tells itself."""
        whole = time.perf_counter() - self.start
        rendering = whole - self.loading if rendering is None else rendering
        self.told(version, spp, whole - rendering, rendering)

    def told(self, version, spp, loading, rendering):
        """The program tells all of it."""
        report = {"version": version, "spp": spp, "loading": loading, "rendering": rendering}
        self.report.write_text(json.dumps(report))

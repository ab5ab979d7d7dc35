"""Renders a scene of race.py with Mitsuba, in a process of its own, so that its start-up can be measured.

    race_mitsuba.py JOB

JOB is JSON: `variant`, `threads`, `folder`, `scene`, `sampler`, `max_depth`, `rr_depth`, and `renders`, a list of
[samples, seed, picture]. Prints JSON: the time of the clock when the first picture was written and the processor seconds up to
then (`written`, `cpu`), the seconds of importing and loading (`load`), and for each render its seconds, its processor seconds
and how many samples it took.
"""

import json
import sys
import time


def main():
    start = time.perf_counter()
    job = json.loads(sys.argv[1])
    import drjit as dr
    import mitsuba as mi

    dr.set_thread_count(job["threads"])
    mi.set_variant(job["variant"])
    # Where a sampler takes more samples than it is asked for, the answer says how many.
    mi.set_log_level(mi.LogLevel.Error)

    from pathlib import Path

    import race_scenes

    options = (job[key] for key in ("sampler", "max_depth", "rr_depth"))
    scene = mi.load_dict(race_scenes.scene(job["scene"], Path(job["folder"]), *options))
    dr.sync_thread()
    load = time.perf_counter() - start

    renders, written, cpu = [], None, None
    for samples, seed, picture in job["renders"]:
        begin, busy = time.perf_counter(), time.process_time()
        image = mi.render(scene, spp=samples, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        seconds, busy = time.perf_counter() - begin, time.process_time() - busy
        mi.Bitmap(image).write(picture)
        written, cpu = written or time.time(), cpu or time.process_time()
        sampler = scene.sensors()[0].sampler()
        sampler.set_sample_count(samples)
        renders.append([seconds, busy, sampler.sample_count()])
    print(json.dumps({"written": written, "cpu": cpu, "load": load, "renders": renders}))


if __name__ == "__main__":
    main()

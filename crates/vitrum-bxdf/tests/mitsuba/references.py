"""Reference values of five scattering models, written by Mitsuba 3.9.1, a renderer that owes nothing to this one.

    pip install mitsuba==3.9.1 numpy
    python3 references.py

rewrites the CSV files beside this script:

    dielectric.csv       a smooth interface: both children of a direction, with probability and weight
    thindielectric.csv   a thin sheet: the same
    conductor.csv        a smooth metal: its reflectance
    roughdielectric.csv  a rough interface (GGX): value, cosine included, and density of a pair of directions
    roughconductor.csv   a rough metal (GGX): the same

Directions are local: z is the normal, and both point away from the surface. `wo` is the known direction, from which a
path arrives, and `wi` the one that is sampled; Mitsuba names them the other way round. Above (z > 0) the index of
refraction is `ext_ior`, below it is `int_ior`. `mode` says what is transported: radiance (a path from the camera) or
importance (one from the light).

The published wheel of Mitsuba has no variant in double precision, so every value is one of single precision, and so are
the parameters and directions behind it: read every number as a single and widen it afterwards. Nine significant digits
are enough for that to be exact. `wo`, and `wi` of the rough models, are of unit length to the last place of a single.
`wi` of the smooth ones is as Mitsuba returned it.
"""

import csv
import math
import pathlib

import drjit as dr
import mitsuba as mi
import numpy as np

VERSION = "3.9.1"
FOLDER = pathlib.Path(__file__).resolve().parent

WO, WI = ["wo_x", "wo_y", "wo_z"], ["wi_x", "wi_y", "wi_z"]
AZIMUTH = 0.7
ANGLES = [0, 10, 20, 30, 40, 50, 60, 70, 80, 85, 89]
ROUGH_ANGLES = [0, 30, 60, 80]
# Along x and along y.
ALPHAS = [(0.1, 0.1), (0.3, 0.3), (0.7, 0.7), (1.0, 1.0), (0.1, 0.4), (0.6, 0.2)]
# Smaller values of a rough model say more about the rounding of singles than about the model.
SMALLEST = 1e-4

# The first number given to BSDF.sample chooses the lobe: reflection up to its probability, transmission beyond it.
LOBES = {"reflection": 0.0, "transmission": 1 - 2**-24}


def modes():
    return {"radiance": mi.TransportMode.Radiance, "importance": mi.TransportMode.Importance}


def unit(x, y, z):
    """The direction normalised in double precision, then rounded to single."""
    length = math.hypot(x, y, z)
    return tuple(float(np.float32(c / length)) for c in (x, y, z))


def direction(degrees, side):
    """At an angle to the normal above (side = 1) or to its opposite below (side = -1)."""
    angle = math.radians(degrees)
    across = math.sin(angle)
    return unit(across * math.cos(AZIMUTH), across * math.sin(AZIMUTH), side * math.cos(angle))


def interaction(wo):
    """What Mitsuba wants to know of the point hit: there, the known direction is `wi`."""
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(*wo)
    return si


def grey(colour):
    """The value that all three channels share."""
    r, g, b = (float(c) for c in colour)
    assert r == g == b, f"the channels differ: {r}, {g}, {b}"
    return r


def number(x):
    """Nine significant digits, without the sign of a negative zero."""
    return x if isinstance(x, str) else "%.9g" % (x + 0.0)


def write(name, columns, rows):
    path = FOLDER / f"{name}.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([number(x) for x in row] for row in rows)
    print(path.name)


def children(bsdf, wo, mode):
    """Both children of a smooth model: lobe, direction, probability, weight (value over probability) and index ratio.

    A child that does not exist, as under total internal reflection, is left out."""
    for component, (lobe, choice) in enumerate(LOBES.items()):
        sample, weight = bsdf.sample(mi.BSDFContext(modes()[mode]), interaction(wo), choice, mi.Point2f(0.5, 0.5))
        if sample.sampled_component == component:
            yield lobe, tuple(sample.wo), sample.pdf, grey(weight), sample.eta


def dielectric():
    for ext, int_ in [(1, 1.5), (1, 1.33), (1.33, 1.5), (1, 2.42), (1, 1.0003), (1.5, 1), (1, 4)]:
        bsdf = mi.load_dict({"type": "dielectric", "ext_ior": float(ext), "int_ior": float(int_)})
        critical = math.degrees(math.asin(min(ext, int_) / max(ext, int_)))
        for side in (1, -1):
            dense = (int_ > ext) == (side < 0)
            # Nearer to the critical angle of indices this alike, rounding to singles costs the fourth digit.
            below = [0.5] if abs(int_ - ext) < 0.01 else [0.5, 0.05]
            near = [critical + 0.05, *(critical - degrees for degrees in below)] if dense else []
            for mode in modes():
                # Nothing but the weight of transmission depends on the mode: fewer angles do for the second.
                angles = ANGLES + near if mode == "radiance" else [0, 20, 40, 60, 80]
                for wo in (direction(angle, side) for angle in sorted(angles)):
                    for lobe, wi, probability, weight, eta in children(bsdf, wo, mode):
                        yield [ext, int_, mode, *wo, lobe, *wi, probability, weight, eta]


def thindielectric():
    for ext, int_ in [(1, 1.5), (1, 1.33), (1.33, 1.5), (1, 2.42)]:
        bsdf = mi.load_dict({"type": "thindielectric", "ext_ior": float(ext), "int_ior": float(int_)})
        for wo in (direction(angle, 1) for angle in ANGLES):
            for lobe, wi, probability, weight, _ in children(bsdf, wo, "radiance"):
                yield [ext, int_, *wo, lobe, *wi, probability, weight]


def conductor():
    for eta, k in [(0.2, 3.9), (1.5, 7.3), (2.9, 3.1), (0.05, 2), (1.5, 0)]:
        bsdf = mi.load_dict({"type": "conductor", "eta": float(eta), "k": float(k)})
        for wo in (direction(angle, 1) for angle in ANGLES):
            _, weight = bsdf.sample(mi.BSDFContext(), interaction(wo), 0.5, mi.Point2f(0.5, 0.5))
            yield [eta, k, *wo, grey(weight)]


# The rough models of Mitsuba, as their source states them. In Mitsuba's names, with m the half vector turned to z > 0:
#
#   masking is separable, not height-correlated: G = G1(wi) G1(wo), where
#   G1(v) = 2 / (1 + sqrt(1 + (alpha_u² v_x² + alpha_v² v_y²) / v_z²)), or 0 if dot(v, m) and v_z differ in sign;
#   m is along wi + wo in reflection, along wi + eta wo in transmission, eta being the index on the side of wo over that
#   on the side of wi;
#   the density of m is that of visible normals, D(m) G1(wi) |dot(wi, m)| / |wi_z|, taken to wo by the Jacobian of the
#   half vector and, for a dielectric, times the Fresnel reflectance at dot(wi, m), or what it leaves to one;
#   transmission has the factor 1 / eta² when radiance is transported, and none when importance is.


def evaluations(bsdf, wo, lobe, mode, start, most):
    """Up to `most` sampled directions of one lobe, with their value and density: wi, eval, pdf.

    The points given to the sampler are those of an additive recurrence (the R2 sequence) from `start` on. Directions
    are made unit vectors of single precision before anything is asked about them."""
    si, context, found = interaction(wo), mi.BSDFContext(modes()[mode]), 0
    for i in range(start, start + 12):
        point = mi.Point2f((0.5 + 0.7548776662 * i) % 1, (0.5 + 0.5698402910 * i) % 1)
        sample, _ = bsdf.sample(context, si, LOBES[lobe], point)
        wi = unit(*sample.wo) if sample.pdf > 0 else (0.0, 0.0, 0.0)
        # Sampling can also end on the wrong side of the surface, or reflect where it should transmit.
        if wi[2] * wo[2] * (1 if lobe == "reflection" else -1) <= 0:
            continue
        value = grey(bsdf.eval(context, si, mi.Vector3f(*wi)))
        if value > SMALLEST:
            yield wi, value, bsdf.pdf(context, si, mi.Vector3f(*wi))
            found += 1
            if found == most:
                return


def rough(kind, alpha, **parameters):
    return mi.load_dict({"type": kind, "distribution": "ggx", "sample_visible": True, "alpha_u": alpha[0],
                         "alpha_v": alpha[1], **{name: float(x) for name, x in parameters.items()}})


def roughdielectric():
    start = 0
    for ext, int_ in [(1, 1.5), (1.33, 1.5), (1, 2.42), (1.5, 1)]:
        for alpha in ALPHAS:
            bsdf = rough("roughdielectric", alpha, ext_ior=ext, int_ior=int_)
            for side in (1, -1):
                for angle in ROUGH_ANGLES:
                    wo = direction(angle, side)
                    # One direction a lobe keeps the file small; each time it is another one.
                    start += 1
                    for lobe in LOBES:
                        # The mode matters to transmission only, and there not to the angle.
                        both = lobe == "transmission" and angle == 30
                        for mode in modes() if both else ["radiance"]:
                            for wi, value, density in evaluations(bsdf, wo, lobe, mode, start, 1):
                                yield [ext, int_, *alpha, mode, *wo, *wi, value, density]


def roughconductor():
    start = 0
    for eta, k in [(0.2, 3.9), (1.5, 7.3)]:
        for alpha in ALPHAS:
            bsdf = rough("roughconductor", alpha, eta=eta, k=k)
            for wo in (direction(angle, 1) for angle in ROUGH_ANGLES):
                start += 6
                for wi, value, density in evaluations(bsdf, wo, "reflection", "radiance", start, 6):
                    yield [eta, k, *alpha, *wo, *wi, value, density]


def main():
    assert mi.__version__ == VERSION, f"these are the values of Mitsuba {VERSION}, this is {mi.__version__}"
    mi.set_variant("scalar_rgb")
    write("dielectric", ["ext_ior", "int_ior", "mode", *WO, "lobe", *WI, "probability", "weight", "eta"], dielectric())
    write("thindielectric", ["ext_ior", "int_ior", *WO, "lobe", *WI, "probability", "weight"], thindielectric())
    write("conductor", ["eta", "k", *WO, "weight"], conductor())
    alphas = ["alpha_u", "alpha_v"]
    write("roughdielectric", ["ext_ior", "int_ior", *alphas, "mode", *WO, *WI, "eval", "pdf"], roughdielectric())
    write("roughconductor", ["eta", "k", *alphas, *WO, *WI, "eval", "pdf"], roughconductor())


if __name__ == "__main__":
    main()

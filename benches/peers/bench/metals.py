"""Indices of refraction of metals for red, green and blue, n and k, as in crates/vitrum-materials/src/metal_table.rs."""

METALS = {"gold": ((0.14737, 0.49189, 1.48291), (4.74145, 2.23988, 1.78051))}

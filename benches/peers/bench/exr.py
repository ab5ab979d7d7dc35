"""Pictures of linear radiance: rows from the top, float32, three channels."""

import numpy as np
import OpenEXR


def read(path) -> np.ndarray:
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return np.stack([channels[name].pixels for name in "RGB"], -1).astype(np.float32)


def attribute(path, key):
    """What the header says, or None."""
    with OpenEXR.File(str(path), header_only=True) as file:
        return file.header().get(key)


def write(path, pixels):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    channels = {name: np.ascontiguousarray(pixels[..., i], np.float32) for i, name in enumerate("RGB")}
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))

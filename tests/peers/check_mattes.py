"""Cryptomatte layers as cryptomatte-api, a decoder of others, takes them apart: by name, whole.

usage: check_mattes.py RELIEF"""
import pathlib
import subprocess
import sys
import tempfile

import cryptomatte_api
import numpy

RELIEF = sys.argv[1]


def load(file):
    """Name of the layer to coverage by name of the matte."""
    layers = {}
    for layer in cryptomatte_api.Cryptomatte.load(str(file)):
        metadata = layer.metadata()
        masks = {name: numpy.asarray(mask) for name, mask in layer.masks().items()}
        layers[metadata.name() if callable(metadata.name) else metadata.name] = masks
    return layers


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    subprocess.run([RELIEF, "scene", "party", "-o", folder / "party", "-q"], check=True)
    picture = folder / "party.exr"
    subprocess.run([RELIEF, "render", folder / "party" / "scene.json", "-o", picture, "--size", "160x90", "--spp", "8",
                    "--bounces", "0", "--layers", "CryptoObject,CryptoMaterial", "-q"], check=True)
    layers = load(picture)
    assert sorted(layers) == ["CryptoMaterial", "CryptoObject"], sorted(layers)
    objects, materials = layers["CryptoObject"], layers["CryptoMaterial"]
    assert len(objects) > 100 and len(materials) > 10, (len(objects), len(materials))
    assert numpy.array_equal(objects["ground"], materials["ground"]), "one object is of that material"
    assert materials["ground"].mean() > 0.1
    for masks in (objects, materials):
        total = sum(masks.values())
        assert total.shape == (90, 160) and total.min() == 0 and abs(total.max() - 1) < 1e-6, (total.min(), total.max())
    # Material by material, what its objects have: they are named after it, but for their numbers.
    pumpkins = sum(mask for name, mask in objects.items() if name.startswith("pumpkin"))
    shells = sum(mask for name, mask in materials.items() if name.startswith("pumpkin"))
    print(f"{len(objects)} objects, {len(materials)} materials; pumpkins {pumpkins.mean():.4f} and {shells.mean():.4f}")
    assert abs(pumpkins - shells).max() < 1e-6


if __name__ == "__main__":
    main()

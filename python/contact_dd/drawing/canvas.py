"""Axes, units and files of pictures."""

import io

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.transforms import ScaledTranslation
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from PIL import Image

from contact_dd import files
from contact_dd.drawing.plane import curves
from contact_dd.drawing.units import in_units

# Of axes, and of what stands around them (inches).
LARGEST, AROUND = 5.0, (1.8, 1.2)

LARGEST_PNG = 300_000

# Of 255, what counts as white in a palette.
NEARLY_WHITE = 247

# Pixels in one direction for each one of the picture: where antialiased triangles meet, hairlines
# would shine through.
OVERSAMPLED = 2


def canvas(title, units, points):
    """A figure with axes of the shape of `points`."""
    wide, tall = np.ptp(points, axis=0)
    width, height = LARGEST * np.array([wide, tall]) / max(wide, tall)
    size = max(width, 2.5) + AROUND[0], max(height, 1.0) + AROUND[1]
    figure, axes = plt.subplots(figsize=size, layout="constrained")
    axes.set_aspect("equal")
    axes.set_title(title)
    axes.set_xlabel(f"x [{units.length}]")
    axes.set_ylabel(f"y [{units.length}]")
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def deformation_of(result, scale):
    """Scale of the deformed shapes, in words."""
    since = f", since step {result.since}" if result.since else ""
    return f"deformation × {scale:g}{since}"


def lines(axes, points, facets, **style):
    axes.add_collection(LineCollection(curves(points, facets), capstyle="round", **style))


def legend(axes, columns):
    # Below the axis, whatever the height of the axes (inches).
    below = 0.5 / (axes.figure.get_figheight() - AROUND[1])
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -below), ncol=columns, frameon=False)


def scale_bar(axes, width, units, down=0.0):
    """A bar of a round length, about a fifth of `width`, below the axes on the left, so much further down (inches)."""
    length = round_below(0.25 * width)
    (shown,), unit = in_units(np.array([length]), units.length)
    bar = AnchoredSizeBar(
        axes.transData, length, f"{shown:g} {unit}", loc="upper left", pad=1.0, sep=4,
        frameon=False, size_vertical=0.006 * width, bbox_to_anchor=(0, 0),
        bbox_transform=axes.transAxes + ScaledTranslation(0, -down, axes.figure.dpi_scale_trans),
    )
    axes.add_artist(bar)


def directions(axes, names, down=0.0):
    """Arrows along both coordinates, with their names, below the axes on the right, so much further down (inches)."""
    inches = axes.figure.dpi_scale_trans + ScaledTranslation(1, 0, axes.transAxes)
    corner = np.array([-0.42, -0.5 - down])
    for along, name in zip(np.eye(2), names, strict=True):
        arrow = {"arrowstyle": "-|>", "lw": 0.9, "fc": "k", "shrinkA": 0, "shrinkB": 0, "mutation_scale": 8}
        axes.annotate("", corner + 0.24 * along, corner, inches, inches, arrowprops=arrow, annotation_clip=False)
        axes.annotate(name, corner + 0.32 * along, xycoords=inches, ha="center", va="center", fontsize=9,
                      annotation_clip=False)


def round_below(value):
    """The largest of 1, 2 and 5 times a power of ten that isn't above `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(step for step in (1, 2, 5) if step * power <= value * (1 + 1e-9)))


def save(figure, path):
    """Saves a PNG of at most LARGEST_PNG bytes: with a palette, and with fewer pixels if need be. Raises
    `OutputError`."""
    for dpi in (160, 140, 120, 100, 80, 60):
        drawn = io.BytesIO()
        figure.savefig(drawn, dpi=OVERSAMPLED * dpi)
        image = Image.open(drawn).convert("RGB")
        image = image.resize([side // OVERSAMPLED for side in image.size], Image.Resampling.BOX)
        found = io.BytesIO()
        with_palette(image).save(found, "PNG", optimize=True)
        if len(found.getvalue()) <= LARGEST_PNG:
            break
    plt.close(figure)
    files.write(path, found.getvalue())
    print(path)


def with_palette(image):
    """The image in 256 colours, white among them; those of few pixels get more than their share.

    Each pixel gets the nearest of them; Pillow's own choice may be another, which shows in plain areas."""
    red, green, blue = np.moveaxis(np.asarray(image).astype(np.int32), 2, 0)
    packed, pixels, counts = np.unique(
        red << 16 | green << 8 | blue, return_inverse=True, return_counts=True
    )
    colours = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1)
    sample = np.repeat(colours, np.ceil(counts**0.4).astype(int), axis=0)
    chosen = Image.fromarray(sample[None].astype(np.uint8)).quantize(256, kmeans=1)
    entries = np.array(chosen.getpalette()[: 3 * 256]).reshape(-1, 3)
    entries[entries.min(axis=1) >= NEARLY_WHITE] = 255
    entries[entries.sum(axis=1).argmax()] = 255
    # |c - e|² without |c|², which is the same for all entries.
    nearest = ((entries**2).sum(axis=1) - 2 * colours @ entries.T).argmin(axis=1)
    indexed = Image.fromarray(nearest[pixels].reshape(red.shape).astype(np.uint8))
    indexed.putpalette(entries.ravel().tolist())
    return indexed

"""The plot of a study: quantities over the parameter that is varied first."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import EngFormatter


def curves(study):
    """Every quantity in axes of its own, a line for every combination of the other parameters; dotted where a case has
    no solution."""
    count = len(study.quantities)
    figure, rows = plt.subplots(count, squeeze=False, sharex=True, figsize=(7, 1 + 2.2 * count), layout="constrained")
    over, others = study.values[:, 0], study.values[:, 1:]
    converged = np.array([status == "converged" for status in study.status])
    for axes, (name, values) in zip(rows[:, 0], study.quantities.items(), strict=True):
        for other in np.unique(others, axis=0):
            cases = np.flatnonzero((others == other).all(axis=1))
            cases = cases[np.argsort(over[cases], kind="stable")]
            named = zip(study.parameters[1:], other, strict=True)
            label = ", ".join(f"{parameter} = {value:g}" for parameter, value in named)
            axes.plot(over[cases], np.where(converged, values, np.nan)[cases], marker=".", label=label)
        for value in np.unique(over[~converged]):
            axes.axvline(value, color="0.6", linestyle=":")
        axes.set_ylabel(name)
        axes.yaxis.set_major_formatter(EngFormatter())
        axes.grid(alpha=0.3)
    rows[-1, 0].set_xlabel(study.parameters[0])
    if others.shape[1]:
        figure.legend(*rows[0, 0].get_legend_handles_labels(), loc="outside upper center", fontsize="small")
    return figure

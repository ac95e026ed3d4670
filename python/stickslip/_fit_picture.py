"""The picture of a fit: record and model on one axis, cycles over one another, what is left over."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._optional import needed
from ._records import find_falls, smooth

if TYPE_CHECKING:
    import matplotlib.figure

    from ._fit import Fit

CYCLES = 30           # that are laid over one another
EVENTS_SHOWN = 12     # of a long record, on the common axis


def draw(fit: Fit) -> matplotlib.figure.Figure:
    """A row a record."""

    targets = fit._targets
    figure = needed('matplotlib.figure', 'fit').Figure(figsize=(12, 3.4 * len(targets)), layout='constrained')
    for (together, cycles, rest), target in zip(figure.subplots(len(targets), 3, squeeze=False,
                                                                width_ratios=(2, 1.2, 1.2)), targets):
        analysis = target.analysis
        measured = (analysis.time, analysis.force, analysis.falls)
        time, force = analysis.like(*fit.simulate(target))
        falls = find_falls(time, smooth(force, analysis.window), analysis.threshold)
        computed = (time, force, falls if analysis.from_rest else falls.part(slice(5, None)))
        _together(together, analysis, measured, computed)
        for (moment, pull, events), colour, label in ((measured, '0.6', 'measured'), (computed, 'C3', 'computed')):
            _cycles(cycles, moment, pull, events, colour, label)
        _left_over(rest, fit, target)
    return figure


def _together(axes, analysis, measured, computed) -> None:
    """Both forces against time; the first events shown coincide."""
    shift = measured[2].middle[0] - computed[2].middle[0] if len(computed[2]) else 0.0
    end = measured[2].middle[min(EVENTS_SHOWN, len(measured[2]) - 1)] + 0.5 * analysis.period
    for (time, force, _), moved, colour, label in ((measured, 0.0, '0.6', 'measured'), (computed, shift, 'C3', 'computed')):
        shown = (time + moved >= 0.0) & (time + moved <= end)
        axes.plot(time[shown] + moved, force[shown], color=colour, lw=1.0, label=label)
    axes.set(xlabel='time [T]', ylabel='spring force [F]', title=analysis.record.name)
    axes.legend(loc='lower right', fontsize='small')


def _cycles(axes, time, force, falls, colour, label) -> None:
    """Cycles from drop to drop, against the part of the period."""
    phase = np.linspace(-0.2, 1.0, 121)
    middle = falls.middle[1:]
    for begin, end in list(zip(middle[:-1], middle[1:]))[:CYCLES]:
        axes.plot(phase, np.interp(begin + phase * (end - begin), time, force), color=colour, lw=0.6, label=label)
        label = None
    axes.set(xlabel='time since a drop [periods]', ylabel='spring force [F]')
    axes.legend(loc='lower right', fontsize='small')


def _left_over(axes, fit: Fit, target) -> None:
    """Misfit of each feature, in standard deviations."""
    first = sum(other.values.size for other in fit._targets[:fit._targets.index(target)])
    misfit = fit._problem.misfit(fit._problem.evaluate('full', [fit._candidate])[0])[first:first + target.values.size]
    names = np.array(target.names)
    place = np.arange(names.size)
    for name in dict.fromkeys(target.names):
        part = names == name
        axes.plot(place[part], misfit[part], 'o', ms=3, label=name)
    axes.axhspan(-2, 2, color='0.9', zorder=0)
    axes.set(xlabel='feature', ylabel='misfit [standard deviations]', xticks=[])
    axes.legend(fontsize='small')

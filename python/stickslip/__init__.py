"""Elastoplastic friction: updates of contact points, the program's slider, constants from measured records.

docs/python.md of the project shows each of them at work.
"""
from . import laws
from ._library import message, version as __version__
from ._run import InputError, Run, RunError, run
from ._update import Result, update

__all__ = ['InputError', 'Result', 'Run', 'RunError', '__version__', 'laws', 'message', 'run', 'update']

"""Packages that only parts of this one need."""
from __future__ import annotations

import importlib
from types import ModuleType


def needed(module: str, extra: str) -> ModuleType:
    """Imports a module; an ImportError names the extra of this package that brings it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition('.')[0]
        raise ImportError(f"stickslip: this needs {package}: install the package as 'stickslip[{extra}]', or pip install "
                          f'{package}') from error

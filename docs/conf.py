"""How Sphinx builds these pages: ``make docs``."""

import shutil
import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

project = "iiwa_dnn"
author = "The iiwa_dnn developers"
copyright = author
version = release = installed_version("iiwa-dnn")

# The notebooks lie beside the pages' folder; they are shown as they are kept.
HERE = Path(__file__).parent
shutil.rmtree(HERE / "notebooks", ignore_errors=True)
shutil.copytree(HERE.parent / "notebooks", HERE / "notebooks")

sys.path.insert(0, str(HERE))
from api_pages import write_pages  # noqa: E402

write_pages(HERE / "api")

extensions = [
    "myst_nb",
    "sphinx-mathjax-offline",  # formulas without a network
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
nb_execution_mode = "off"
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
# Pages are read on the forge too, where a link to a folder or a script is a link as any other.
myst_links_external_new_tab = False
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
_ALIASES = [
    "ArrayLike",
    "Vector",
    "Matrix",
    "IntVector",
    "Array",
    "IntArray",
    "CodeArray",
    "Mode",
    "Motion",
    "Policy",
]
autodoc_type_aliases = {name: name for name in _ALIASES}
autodoc_type_aliases |= {f"checks.{name}": name for name in _ALIASES}
napoleon_google_docstring = True
napoleon_numpy_docstring = False
# The classes say it in their docstrings; the field's own comment would say it twice.
napoleon_use_ivar = True
napoleon_attr_annotations = False

html_extra_path = ["heart.html", "shield-live.html"]
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_theme = "furo"
pygments_dark_style = "monokai"  # without lines under the names of modules
# Lines of 95 characters without a scroll bar.
FONT = {"code-font-size": "0.75rem"}
html_theme_options = {"light_css_variables": FONT, "dark_css_variables": FONT}
html_title = "iiwa_dnn"
html_show_sphinx = False


def setup(app: Any) -> None:
    """Correct what autodoc and napoleon show of named tuples, properties and constants."""
    app.connect("autodoc-skip-member", skip_field, priority=400)
    app.connect("autodoc-process-docstring", keep_colon, priority=400)


def skip_field(app: Any, what: str, name: str, found: Any, skip: bool, options: Any) -> bool | None:
    """Leave out the fields of a named tuple, which its docstring lists."""
    return True if type(found).__name__ == "_tuplegetter" else None


def keep_colon(app: Any, what: str, name: str, found: Any, options: Any, lines: list[str]) -> None:
    """Replace the colon of a property or constant that napoleon takes for the end of a type."""
    if what in ("property", "attribute", "data"):
        lines[0] = lines[0].replace(": ", " – ", 1)

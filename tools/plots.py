"""What the scripts that draw the program's JSON share: reading it, writing the picture, words for what goes wrong."""
import argparse
import io
import json
import pathlib
import sys

import matplotlib

from files import read_text, whole_file

matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402,F401  (the backend must be chosen first)

SCHEMA = 1
# Okabe & Ito: for all eyes
BLUE, RED, GREEN, PINK, ORANGE, SKY, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666"
COLOURS = [BLUE, RED, GREEN, PINK, ORANGE, SKY]


class BadInput(Exception):
    pass


def read_report(path, command):
    """The JSON of a command of the program, of the schema that is read here (docs/json.md)."""
    report = json.loads(read_text(path))
    if report.get("schema_version") != SCHEMA or report.get("command") != command:
        raise BadInput(f"schema_version {report.get('schema_version')} of {report.get('command')}, expected {SCHEMA} of {command}")
    return report


def save(figure, output):
    form = output.suffix[1:] or "png"
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=100, format=form, metadata={"Software": None} if form == "png" else None)
    with whole_file(output) as file:
        file.write(drawn.getvalue())


def main(text, command, draw):
    """`text`: of --help. `draw(report)`: the figure."""
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(command, type=pathlib.Path, help=f"JSON of raycache {command}")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="picture to write (.png, .svg)")
    arguments = parser.parse_args()
    path, name = getattr(arguments, command), pathlib.Path(sys.argv[0]).name
    try:
        save(draw(read_report(path, command)), arguments.output)
    except OSError as error:
        sys.exit(f"{name}: error: {error}")
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, BadInput) as error:
        sys.exit(f"{name}: error: {path}: not the output of raycache {command} --json: {error!r}")

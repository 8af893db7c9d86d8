# SPDX-License-Identifier: Apache-2.0
"""python3 -m flatlight sweep FILE: a matrix of settings, rendered by a server. Exit status as that of `flatlight`."""
import argparse
import os
import sys

from flatlight import sweep_table
from flatlight.client import Client
from flatlight.errors import BadRequest, Denied, Error, Unreachable
from flatlight.sweep import Sweep

DONE, FAILED, USAGE, UNREACHABLE, DENIED, OUTPUT, INTERRUPTED = 0, 1, 2, 3, 4, 5, 130


def main(arguments=None):
    options = _parse(arguments)
    try:
        return _sweep(options)
    except KeyboardInterrupt:
        print("flatlight: interrupted; jobs go on, and the same command finds them", file=sys.stderr)
        return INTERRUPTED
    except Error as error:
        print(f"flatlight: {error}", file=sys.stderr)
        kinds = {BadRequest: USAGE, Unreachable: UNREACHABLE, Denied: DENIED}
        return kinds.get(type(error), FAILED)
    except OSError as error:
        print(f"flatlight: {error.filename}: {error.strerror}", file=sys.stderr)
        return OUTPUT


def _parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m flatlight", description="Flatlight from Python.")
    commands = parser.add_subparsers(dest="command", required=True)
    sweep = commands.add_parser("sweep", help="render a matrix of settings, and tell of all in a table",
                                description="Submits each run of FILE as a job, waits for all and prints a table. What was "
                                "submitted is kept in FILE.jobs: the same command again goes on from there.")
    sweep.add_argument("file", metavar="FILE", help="the sweep, in JSON: docs/python.md has its form")
    sweep.add_argument("--server", metavar="ADDRESS", help="HOST:PORT or unix:PATH; default: FLATLIGHT_SERVER")
    sweep.add_argument("-o", metavar="TABLE.csv", dest="table", help="write the table as CSV too")
    sweep.add_argument("--results", metavar="FOLDER", help="write every result there, as NUMBER.json by its row")
    sweep.add_argument("--no-wait", action="store_true", help="submit all, print the table as it stands, and leave")
    sweep.add_argument("--again", action="store_true", help="submit what failed or was cancelled once more")
    sweep.add_argument("--quiet", action="store_true", help="no progress on standard error")
    return parser.parse_args(arguments)


def _sweep(options):
    with Client(options.server) as client:
        sweep = Sweep(client, options.file, quiet=options.quiet)
        sweep.submit(again=options.again)
        if not options.no_wait:
            sweep.wait()
        if options.results:
            os.makedirs(options.results, exist_ok=True)
        rows = []
        for number, run in enumerate(sweep.runs, start=1):
            result = sweep.result(run)
            rows.append(sweep_table.row(number, run, sweep.jobs[run.key], result))
            if options.results and result is not None:
                result.save(os.path.join(options.results, f"{number}.json"))
    varied = sweep_table.varied(sweep.runs)
    print(sweep_table.text(rows, varied))
    if options.table:
        sweep_table.write_csv(options.table, rows, varied)
    return FAILED if any(row["state"] in ("failed", "cancelled") for row in rows) else DONE


if __name__ == "__main__":
    sys.exit(main())

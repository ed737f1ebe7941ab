"""Results of a study: a line of a CSV file for each run, so that it can be stopped and started."""

import csv
import threading


def text(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Results:
    def __init__(self, path, columns, keys):
        """keys: how many of the columns, from the first, name a run."""
        self.path, self.columns, self.keys, self.lock = path, columns, keys, threading.Lock()

    def known(self):
        """Key of a run, as texts -> its line."""
        if not self.path.exists():
            return {}
        return {tuple(row[c] for c in self.columns[:self.keys]): row for row in csv.DictReader(open(self.path))}

    def write(self, row):
        with self.lock:
            is_new = not self.path.exists()
            with open(self.path, "a", newline="") as file:
                out = csv.DictWriter(file, self.columns, lineterminator="\n")
                if is_new:
                    out.writeheader()
                out.writerow({c: text(row.get(c, "")) for c in self.columns})

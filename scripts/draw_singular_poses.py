"""Draw what happens in singular poses into a folder: docs/images, or the one that is given."""

import sys

from iiwa_dnn.studies.singular import save_singular_figure, stretched_run, tilted_run

if __name__ == "__main__":
    vertical = {
        f"{form}, {mode}": tilted_run(form, mode)
        for form in ("so3", "block")
        for mode in ("converged", "continuous")
    }
    stretched = {policy: stretched_run(policy) for policy in ("slow", "relax")}
    folder = sys.argv[1] if len(sys.argv) > 1 else "docs/images"
    print("\n".join(map(str, save_singular_figure(vertical, stretched, folder))))

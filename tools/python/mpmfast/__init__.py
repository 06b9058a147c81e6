"""The material point method engine mpmfast: run scenes, or step them and read the particles as NumPy arrays."""
import os as _os

# Threads that wait spin for long if nobody says otherwise, which makes a run many times slower where other programs
# want the cores. libgomp reads this once, when the engine brings it in; programs started later do not inherit it.
_sets_spin = not {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"} & set(_os.environ)
if _sets_spin:
    _os.environ["GOMP_SPINCOUNT"] = "1000"
try:
    from ._engine import FileError, RunFailure, SceneError, Simulation, __version__, run
finally:
    if _sets_spin:
        del _os.environ["GOMP_SPINCOUNT"]

__all__ = ["FileError", "RunFailure", "SceneError", "Simulation", "run"]

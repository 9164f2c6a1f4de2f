"""Runs of a seam servo: its cycles and their figures, which can be saved, loaded and compared."""

from __future__ import annotations

import json
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError

COMPLETE = "the seam's end was reached"
"""How a run ends that went well."""
SERIES = ("time", "s", "lateral", "commanded", "correction", "seam", "quality", "gap", "deviation", "duration")
"""What is kept of each cycle: times [s], lengths [m], quality [1]."""
BAND = 0.1e-3
"""Deviation within which the tool counts as on the seam [m]."""
PIECE = 0.1
"""Length of the pieces whose standard deviations are compared [m]."""
_AVERAGED = 0.5
"""Time over which a response is averaged [s]."""


@dataclass(frozen=True)
class ServoRun:
    """A run.

    Attributes
    ----------
    seam, controller : str
        What was followed, by what.
    length : float
        Of the seam [m].
    ended : str
        Why it ended.
    series : dict
        Of each name in `SERIES` an array (n,); `s` is 0 where the seam begins.
    counts : dict
        What the client saw: answers, lost and repeated ones.
    """

    seam: str
    controller: str
    length: float
    ended: str
    series: dict[str, NDArray[np.float64]]
    counts: dict[str, int]

    @property
    def is_complete(self) -> bool:
        """Whether the end of the seam was reached."""
        return self.ended == COMPLETE

    @property
    def welded(self) -> NDArray[np.bool_]:
        """Which cycles are on the seam (n,)."""
        s = self.series["s"]
        out: NDArray[np.bool_] = (s >= 0.0) & (s <= self.length)
        return out

    def figures(self) -> dict[str, Any]:
        """Return the figures of the run [mm, s]."""
        series = self.series
        deviation = 1e3 * series["deviation"][self.welded]
        out: dict[str, Any] = {"seam": self.seam, "controller": self.controller, "ended": self.ended}
        response, overshoot = self._response()
        out |= {"response_time_s": response, "overshoot_mm": overshoot}
        if len(deviation):
            half = deviation[len(deviation) // 2 :]
            pieces = self._pieces()
            out |= {
                "residual_mm": round(abs(float(half.mean())), 4),
                "std_mm": round(float(deviation.std()), 4),
                "interval_mm": [round(float(deviation.min()), 4), round(float(deviation.max()), 4)],
                "worst_piece_std_mm": round(1e3 * max(pieces), 4) if pieces else None,
            }
        durations = 1e3 * series["duration"]
        out |= {
            "computing_ms": round(float(np.median(durations)), 4),
            "computing_p99_ms": round(float(np.percentile(durations, 99.0)), 4),
            "seen_percent": round(100.0 * float(np.isfinite(series["seam"]).mean()), 2),
            "gap_mm": _rounded(1e3 * np.nanmedian(series["gap"])) if np.isfinite(series["gap"]).any() else None,
        }
        return out | self.counts

    def save(self, path: Path) -> None:
        """Write the run to a new file.

        Raises
        ------
        UserError
            Where the file is there already, or cannot be written.
        """
        head = {name: getattr(self, name) for name in ("seam", "controller", "length", "ended", "counts")}
        try:
            with open(path, "xb") as file:
                np.savez_compressed(file, head=np.array(json.dumps(head)), **self.series)  # type: ignore[arg-type]
        except FileExistsError:
            raise UserError(f"{path}: is there already") from None
        except OSError as error:
            raise UserError(f"{path}: {error.strerror or error}") from None

    def _response(self) -> tuple[float | None, float | None]:
        """Return when the averaged deviation was first within `BAND`, and how far it then went to the other side."""
        series = self.series
        moving = np.flatnonzero(series["correction"] != 0.0)
        if not len(moving):
            return None, None
        begin = int(moving[0])
        deviation, time = series["deviation"][begin:], series["time"][begin:]
        count = max(int(_AVERAGED / max(float(np.median(np.diff(time))), 1e-6)), 1) if len(time) > 1 else 1
        if len(deviation) < count:
            return None, None
        averaged = np.convolve(deviation, np.full(count, 1.0 / count), mode="valid")
        within = np.flatnonzero(np.abs(averaged) < BAND)
        if not len(within):
            return None, None
        side = np.sign(averaged[0])
        other = float((-side * averaged[: int(within[0]) + 8 * count]).max())
        middle = min(int(within[0]) + count // 2, len(time) - 1)
        return _rounded(float(time[middle] - time[0])), _rounded(1e3 * max(other, 0.0))

    def _pieces(self) -> list[float]:
        """Return the standard deviations of pieces of the seam [m]."""
        s, deviation = self.series["s"], self.series["deviation"]
        starts = np.arange(0.0, self.length - 0.5 * PIECE, PIECE)
        pieces = [deviation[(s >= start) & (s < start + PIECE)] for start in starts]
        return [float(piece.std()) for piece in pieces if len(piece)]


def load(path: Path) -> ServoRun:
    """Return the run of a file.

    Raises
    ------
    UserError
        Where the file is none of a run.
    """
    try:
        with np.load(path, allow_pickle=False) as data:
            head = json.loads(str(data["head"]))
            series = {name: data[name].astype(np.float64) for name in SERIES}
        lengths = {len(one) for one in series.values()}
        if len(lengths) != 1 or not lengths.pop():
            raise ValueError("its series differ in length")
        return ServoRun(
            str(head["seam"]),
            str(head["controller"]),
            float(head["length"]),
            str(head["ended"]),
            series,
            {str(name): int(value) for name, value in head["counts"].items()},
        )
    except FileNotFoundError:
        raise UserError(f"{path}: there is no such file") from None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, EOFError, zipfile.BadZipFile) as error:
        raise UserError(f"{path}: is no run of a seam servo ({error})") from None


def _rounded(value: float) -> float:
    return round(float(value), 4)

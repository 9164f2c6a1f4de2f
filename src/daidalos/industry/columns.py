"""CSV files whose first line names their columns."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_text
from daidalos.common.suggestions import hint

MAX_ROWS = 200_000


def read_columns(
    path: Path, known: tuple[str, ...], text_column: str = ""
) -> tuple[dict[str, NDArray[np.float64]], list[int], tuple[str, ...]]:
    """Return the columns of a CSV file by name, the line of each row, and the texts of one column.

    Raises
    ------
    DocumentError
        Where a column is not known, or a value is no finite number.
    """
    source = str(path)
    rows = csv.reader(io.StringIO(read_text(path)), skipinitialspace=True)
    try:
        head = [name.strip().lower() for name in next(rows, [])]
        if not any(head):
            raise DocumentError("is empty; a line with names of columns is expected", source)
        for number, name in enumerate(head, 1):
            if name not in known:
                raise DocumentError(f"column {number}: there is no column '{name}'{hint(name, known)}", source, 1)
            if head.index(name) != number - 1:
                raise DocumentError(f"column {number}: '{name}' is there twice", source, 1)
        table: list[list[float]] = []
        texts: list[str] = []
        lines: list[int] = []
        for row in rows:
            if not any(cell.strip() for cell in row):
                continue
            if len(row) != len(head):
                raise DocumentError(f"has {len(row)} values, but {len(head)} are expected", source, rows.line_num)
            if len(table) == MAX_ROWS:
                raise DocumentError(f"has more than {MAX_ROWS} points", source, rows.line_num)
            pairs = list(enumerate(zip(head, row, strict=True), 1))
            texts += [cell.strip() for _, (name, cell) in pairs if name == text_column]
            table.append([_number(cell, n, source, rows.line_num) for n, (name, cell) in pairs if name != text_column])
            lines.append(rows.line_num)
    except csv.Error as error:
        raise DocumentError(f"is no CSV: {error}", source, rows.line_num) from None
    names = [name for name in head if name != text_column]
    values = np.array(table, dtype=np.float64).reshape(len(table), len(names))
    return {name: values[:, index] for index, name in enumerate(names)}, lines, tuple(texts)


def _number(cell: str, column: int, source: str, line: int) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DocumentError(f"column {column}: '{cell.strip()}' is no finite number", source, line)
    return value

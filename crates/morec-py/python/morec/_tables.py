"""Tables of results."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas

#: Rows that a notebook shows.
SHOWN = 20


class Table(list[dict[str, Any]]):
    """Rows of a result: a list of dictionaries that all have the same keys.

    ``pandas.DataFrame(table)`` takes it as it is, `to_pandas` keeps the columns of a table without rows too.

    Attributes
    ----------
    columns : list of str
        Names of the columns, in order.
    """

    columns: list[str]

    def __init__(self, rows: Iterable[dict[str, Any]] = (), columns: Sequence[str] = ()) -> None:
        super().__init__(rows)
        self.columns = list(columns) or (list(self[0]) if self else [])

    def column(self, name: str) -> list[Any]:
        """The values of a column, one for each row."""
        if name not in self.columns:
            raise KeyError(f"no column is called {name!r}; there are {', '.join(self.columns)}")
        return [row[name] for row in self]

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a pandas DataFrame (needs pandas)."""
        import pandas

        return pandas.DataFrame(list(self), columns=self.columns)

    def __reduce__(self) -> tuple[type[Table], tuple[list[dict[str, Any]], list[str]]]:
        return Table, (list(self), self.columns)

    def __repr__(self) -> str:
        rows = "\n".join(f"  {row}" for row in self[:SHOWN])
        more = f"\n  … {len(self) - SHOWN} more" if len(self) > SHOWN else ""
        return f"<morec.Table of {len(self)} rows: {', '.join(self.columns)}>\n{rows}{more}".rstrip()

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_shown(row.get(name)))}</td>" for name in self.columns) + "</tr>"
            for row in self[:SHOWN]
        )
        more = f"<p>{len(self) - SHOWN} more rows</p>" if len(self) > SHOWN else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _shown(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.3f}" if isinstance(value, float) else str(value)

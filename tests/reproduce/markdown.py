"""Numbers and tables as Markdown."""
import math


def number(value, digits=3):
    """With so many significant digits, and no exponent where a person would write none."""
    if value is None:
        return ""
    if value == int(value) and abs(value) < 1e7:
        return str(int(value))
    size = math.floor(math.log10(abs(value)))
    if size < -4 or size > 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - size)}f}"


def with_error(here):
    """The error to two digits, the value to the same place: 22.84 +- 0.14."""
    if here is None:
        return "not run"
    if isinstance(here, str):
        return here
    if not here.error:
        return number(here.value, 4)
    places = min(6, max(0, 1 - math.floor(math.log10(here.error))))
    return f"{here.value:.{places}f} ± {here.error:.{places}f}"


def z_text(z):
    return "" if z is None else f"{z:+.1f}"


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows])


def duration(seconds):
    if seconds is None:
        return "unknown"
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"


def listed(names):
    names = list(names)
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " and " + names[-1]

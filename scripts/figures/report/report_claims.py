# SPDX-License-Identifier: Apache-2.0
"""Words of the report that depend on figures."""

from report.report_data import rounded


def listing(words):
    """Returns "a, b and c"."""
    words = [str(word) for word in words]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else "none"


def count_of(items, good, what):
    """Returns "all 12 rows", "5 of 12 rows" or "the one row", of items with the name `what`."""
    items = list(items)
    count = sum(1 for item in items if good(item))
    if count < len(items):
        return f"{count} of {len(items)} {what}s"
    return f"all {count} {what}s" if count > 1 else f"the one {what}"


def times(new, old):
    """Returns how many times `old` the value `new` is, as a phrase about a number that is larger or smaller."""
    if old <= 0:
        return "as much as 0" if new == old else "more than 0"
    ratio = new / old
    return f"{rounded(ratio, 3 if ratio >= 1 else 2)} times"


def convergence(orders):
    """Returns what errors with these orders in N do."""
    if not orders:
        return "cannot be judged from one N"
    least = min(orders)
    span = f"order {orders[0]:.2f}" if len(orders) == 1 else f"orders from {least:.2f} to {max(orders):.2f}"
    if least >= 0.75:
        return f"converges with N ({span})"
    if least >= 0.1:
        return f"falls slowly with N ({span})"
    if max(abs(order) for order in orders) < 0.1:
        return f"stays at every N ({span})"
    return f"grows with N ({span})" if max(orders) <= -0.1 else f"does not fall reliably with N ({span})"


def growth(exponent):
    """Returns how a number grows with N."""
    return f"like N^{exponent:.2f}" if exponent > 0.05 else "hardly" if exponent > -0.05 else f"not; it falls like N^{exponent:.2f}"


def compared(ours, others):
    """Returns which of `others`, a dictionary of errors, is below the error `ours`."""
    better = [name for name, error in others.items() if error < ours]
    if better:
        return f"smaller with {listing(better)}"
    best = min(others.values())
    return f"at least {best / ours:.3g} times as large with the others" if ours > 0 else "larger with the others"

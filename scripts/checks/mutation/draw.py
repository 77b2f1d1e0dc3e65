# SPDX-License-Identifier: Apache-2.0
"""Draws bugs by a rule.

The product's sources are put in the order of a hash of the seed and their name. Each source gives one bug. The hash
modulo the number of kinds in the source chooses the kind. Of the places of this kind, the one with the smallest hash of
its line is taken. So a change elsewhere in the source draws the same bug again. A bug that does not compile is drawn again from the same
source, and then from a spare one. No other bug is discarded.
"""

import dataclasses
import hashlib

import product
from sites import sites

ROOT = product.ROOT


def rank(*parts):
    return hashlib.sha256("\0".join(map(str, parts)).encode()).hexdigest()


@dataclasses.dataclass(frozen=True)
class Drawn:
    """A bug in the source `name`, which holds `text`."""

    name: str
    text: str
    site: object

    def planted(self):
        return self.site.planted(self.text)

    def words(self):
        return f"{self.name}:{self.site.line(self.text)}: {self.site.words(self.text)}"


def sources(root=ROOT):
    """Returns the .cpp files of the product, and the scripts that are installed."""
    return [name for name in product.sources(root) if name.startswith("scripts/launcher/") or name.endswith(".cpp")]


def candidates(seed, name, text):
    """Yields the bugs of a source in their order. The first one that compiles is the drawn bug."""
    found = sites(name, text)
    kinds = sorted({site.kind for site in found})
    if not kinds:
        return
    kind = kinds[int(rank(seed, name), 16) % len(kinds)]
    alike = {}
    ranked = []
    for site in found:
        if site.kind == kind:
            key = (site.line_text(text), site.replacement)
            alike[key] = alike.get(key, 0) + 1
            ranked.append((rank(seed, name, *key, alike[key]), site))
    for _, site in sorted(ranked, key=lambda pair: pair[0]):
        yield Drawn(name, text, site)


def drawn(seed, count, root=ROOT):
    """Returns `count` lists of bugs. The first bug of a list that compiles is the drawn one. A list has the bugs of one
    source, and those of another source in case that none of them compiles."""
    ranked = sorted(sources(root), key=lambda name: rank(seed, name))
    lists = [bugs for bugs in (list(candidates(seed, name, (root / name).read_text())) for name in ranked) if bugs]
    spare = lists[count:] + [[]] * count
    return [bugs + more for bugs, more in zip(lists[:count], spare)]

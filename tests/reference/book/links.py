"""Checks the book of the pages: every link leads to a file of the book and to a place in it, and its search
knows the words of the pages.

    python links.py BOOK

BOOK is the folder that mdbook wrote. Needs nothing but Python.
"""

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# A word of each of these pages, which a search must find there.
WORDS = {
    "axes.html": "clockwise",
    "commands.html": "plot-dpi",
    "pmac.html": "PMAC",
    "recipe.html": "aperture",
    "report.html": "spectrum",
}


class Page(HTMLParser):
    """The links of a page, and the places that it has."""

    def __init__(self, file):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.places.update(named[key] for key in ("id", "name") if named.get(key))
        self.links.extend(named[key] for key in ("href", "src") if named.get(key))


def broken(book):
    """The links that lead nowhere, as texts."""
    pages = {file.resolve(): Page(file) for file in sorted(book.rglob("*.html"))}
    for file, page in pages.items():
        # The page of a wrong address names files by their place on a server, and the one for print has
        # all pages in it.
        if file.name in ("404.html", "print.html", "toc.html"):
            continue
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            name = file.relative_to(book.resolve())
            if not target.exists():
                yield f"{name}: {link} is not in the book"
            elif parts.fragment and target in pages:
                if unquote(parts.fragment) not in pages[target].places:
                    yield f"{name}: {link} has no such place"


def missing_words(book):
    """The words that the search does not know, as texts."""
    index = next(book.glob("searchindex*.js")).read_text(encoding="utf-8")
    quoted = re.search(r"JSON\.parse\('(.*)'\)", index, re.S)
    text = quoted.group(1).replace("\\'", "'").replace("\\\\", "\\")
    data = json.loads(text)
    documents = data["index"]["documentStore"]["docs"]
    urls = data["doc_urls"]
    for page, word in WORDS.items():
        of_page = (docs for number, docs in documents.items() if urls[int(number)].split("#")[0] == page)
        if not any(word in json.dumps(docs, ensure_ascii=False) for docs in of_page):
            yield f"the search does not find {word!r} in {page}"


def main():
    book = Path(sys.argv[1])
    faults = [*broken(book), *missing_words(book)]
    print("\n".join(faults) or "all links hold, and the search knows the pages")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()

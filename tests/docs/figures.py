"""Which numbers of a page are figures, and which of them something has computed again.

A figure is a number of the prose, of a quotation or of an indented block that is no command. Code, links and headings have none."""
import re

NUMBER = re.compile(r"(?<![A-Za-z_\d.])\d+(?:[.,]\d+)*")


def squeezed(text):
    return re.sub(r"\s+", " ", text).strip()


def masked(text):
    """The page with its code, links and headings blank, every character at its place."""
    blank = lambda match: re.sub(r"[^\n]", " ", match[0])
    for pattern in (r"^```.*?^```$", r"^    (posewright|scripts/|cmake ).*$", r"`[^`\n]*`", r"\]\([^)\n]*\)", r"^#.*$"):
        text = re.sub(pattern, blank, text, flags=re.S | re.M if "```" in pattern else re.M)
    return text


def spans(text, phrase):
    """Where a phrase stands, whatever breaks its lines."""
    pattern = r"\s+".join(re.escape(word) for word in phrase.split())
    return [match.span() for match in re.finditer(pattern, text)]


def unexplained(text, explained):
    """Numbers of the page that stand in none of the spans."""
    return [f"line {text.count(chr(10), 0, match.start()) + 1}: nothing computes {match[0]}"
            for match in NUMBER.finditer(masked(text))
            if not any(begin <= match.start() and match.end() <= end for begin, end in explained)]


def indented_blocks(text):
    """Indented blocks that are no commands: where each begins and ends, and its lines."""
    fenced = re.sub(r"^```.*?^```$", lambda match: re.sub(r"[^\n]", " ", match[0]), text, flags=re.S | re.M)
    for match in re.finditer(r"(?:^    (?!posewright |scripts/|cmake ).*\S.*\n)+", fenced, re.M):
        yield match.start(), match.end(), match[0].splitlines()


def missing_lines(lines, output):
    """Lines that the output does not have, in their order; how many spaces part the columns does not count."""
    printed = [squeezed(line) for line in output.splitlines()]
    missing, at = [], 0
    for line in lines:
        try:
            at = printed.index(squeezed(line), at) + 1
        except ValueError:
            missing.append(f"not printed: {squeezed(line)}")
    return missing


def unnoticed(text, complaints):
    """Figures of the page that may be changed without a complaint: there must be none, or the comparison is worth nothing."""
    found = []
    for match in NUMBER.finditer(masked(text)):
        wrong = str((int(match[0][-1]) + 1) % 10)
        if not complaints(text[:match.end() - 1] + wrong + text[match.end():]):
            found.append(f"line {text.count(chr(10), 0, match.start()) + 1}: {match[0]}")
    return found

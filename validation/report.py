"""Collects the rows of the table, and writes docs/validation.md."""
import math

ROUND_OFF = 1e-12


class Report:
    def __init__(self, docs):
        self.docs = docs
        self.parts = []
        self.failures = 0
        self.skipped = 0
        self.count = 0

    def section(self, title, text):
        """Opens a section: a title, what it is about, and an empty table."""
        self.parts.append(f'\n## {title}\n\n{text.strip()}\n\n'
                          '| claim | source | expected | computed | error | allowed | holds |\n|---|---|---|---|---|---|---|\n')

    def row(self, claim, source, expected, computed, allowed, absolute=False):
        """A number against the one it should be; `allowed` is relative unless said otherwise."""
        error = abs(computed - expected)
        if not absolute and expected != 0:
            error /= abs(expected)
        self.judge(claim, source, number(expected), number(computed), error, allowed, absolute)

    def curve(self, claim, source, expected, computed, allowed):
        """Two curves: what they start and end with, and their largest distance."""
        error = max((abs(a - b) for a, b in zip(expected, computed)), key=lambda error: (math.isnan(error), error))
        self.judge(claim, source, f'{number(expected[0])} to {number(expected[-1])}',
                   f'{number(computed[0])} to {number(computed[-1])}', error, allowed, True)

    def judge(self, claim, source, expected, computed, error, allowed, absolute):
        holds = math.isfinite(error) and error <= allowed
        self.count += 1
        self.failures += not holds
        shown = f'< {ROUND_OFF:.0e}' if error < ROUND_OFF else f'{error:.1e}'
        kind = ' (abs.)' if absolute else ''
        answer = 'yes' if holds else '**NO**'
        print(f'{"holds" if holds else "FAILS":6}{shown:>9}  {claim}', flush=True)
        self.parts.append(f'| {claim} | {source} | {expected} | {computed} | {shown}{kind} | {allowed:.0e} | {answer} |\n')

    def skip(self, claim, source, expected, why):
        self.skipped += 1
        print(f'skipped: {claim}: {why}', flush=True)
        self.parts.append(f'| {claim} | {source} | {number(expected)} | skipped: {why} | - | - | - |\n')

    def text(self, text):
        self.parts.append('\n' + text.strip() + '\n')

    def picture(self, figure, name, caption):
        """Beside the page, and on it."""
        file = f'validation_{name}.png'
        figure.tight_layout()
        figure.savefig(self.docs / file, dpi=100, metadata={'Software': None})
        self.text(f'![{caption}]({file})')

    def write(self, introduction):
        summary = f'{self.count} rows, {self.failures} failed, {self.skipped} skipped.'
        page = f'# Validation\n\n{introduction.strip()}\n\n**{summary}**\n' + ''.join(self.parts)
        (self.docs / 'validation.md').write_text(page, encoding='utf-8')
        print(summary)
        return self.failures == 0


def number(value):
    return f'{value:.7g}'

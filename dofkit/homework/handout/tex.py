"""A sheet as LaTeX, for whoever sets it with the rest of a course."""

from __future__ import annotations

import re
from collections.abc import Mapping

from dofkit.homework.handout.formulas import formula
from dofkit.homework.handout.markup import written

_HEAD = r"""\documentclass[11pt,a4paper]{article}
\usepackage[utf8]{inputenc}
\usepackage[T1]{fontenc}
\usepackage{amsmath,amssymb}
\usepackage{graphicx}
\usepackage[margin=2.4cm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{0.5em}
\sloppy
\begin{document}
"""
_ESCAPES = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "^": r"\textasciicircum{}",
    "_": r"\_", "~": r"\textasciitilde{}", "%": r"\%", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}", '"': r"\textquotedbl{}", "`": r"\textasciigrave{}", "\u00b2": "$^2$", "\u00b3": "$^3$",
    "\u2212": "$-$", "\u2264": r"$\le$", "\u2265": r"$\ge$", "\u00b7": r"$\cdot$", "\u2013": "--", "\u2026": r"\dots{}",
}  # fmt: skip
_GREEK_LETTERS = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "ζ": "zeta", "η": "eta", "θ": "theta",
    "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma",
    "τ": "tau", "υ": "upsilon", "φ": "varphi", "χ": "chi", "ψ": "psi", "ω": "omega", "Γ": "Gamma", "Δ": "Delta",
    "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
_ESCAPED = {**_ESCAPES, **{letter: rf"$\{name}$" for letter, name in _GREEK_LETTERS.items()}}
_ODD = re.compile("[" + re.escape("".join(_ESCAPED)) + "]|[\u0300-\u036f\x00-\x08\x0b-\x1f]")


def escaped(text: str) -> str:
    """A text as LaTeX reads it back.

    >>> print(escaped("50% of x_A & θ"))
    50\\% of x\\_A \\& $\\theta$
    """
    return _ODD.sub(lambda m: _ESCAPED.get(m[0], ""), text)


class _Tex:
    marks: Mapping[str, str] = {
        "paragraph_close": "\n\n", "line": "\n", "softbreak": "\n", "hardbreak": r"\\" + "\n", "hr": "\n\\hrule\n\n",
        "em_open": r"\emph{", "em_close": "}", "strong_open": r"\textbf{", "strong_close": "}",
        "bullet_list_open": "\\begin{itemize}\n", "bullet_list_close": "\\end{itemize}\n\n",
        "ordered_list_open": "\\begin{enumerate}\n", "ordered_list_close": "\\end{enumerate}\n\n",
        "list_item_open": r"\item ", "blockquote_open": "\\begin{quote}\n", "blockquote_close": "\\end{quote}\n\n",
        "tr_close": r"\par" + "\n", "th_close": r"\quad ", "td_close": r"\quad ",
    }  # fmt: skip

    def text(self, content: str) -> str:
        return escaped(content)

    def code(self, content: str, block: bool) -> str:
        lines = [rf"\texttt{{{escaped(line)}}}" for line in content.splitlines() or [""]]
        return "\\par\n".join(lines) + "\n\n" if block else lines[0]

    def formula(self, content: str, block: bool) -> str:
        found = formula(content)
        if found.mathml is None:
            return rf"\texttt{{{escaped(content)}}}"
        return f"\\[ {found.latex} \\]\n" if block else f"${found.latex}$"

    def picture(self, source: str, alternative: str) -> str:
        path = source.rsplit(".", 1)[0] + ".pdf" if source.endswith(".svg") else source
        return f"\\begin{{center}}\\includegraphics[width=0.7\\linewidth]{{\\detokenize{{{path}}}}}\\end{{center}}"

    def heading(self, level: int, opens: bool) -> str:
        if not opens:
            return "}\n\n"
        return (r"\section*{", r"\subsection*{", r"\subsubsection*{")[min(level, 3) - 1]


def tex_of(markdown: str) -> str:
    """The document; pictures that are SVG are meant as PDF beside them."""
    return f"{_HEAD}{written(markdown, _Tex())}\\end{{document}}\n"

"""The words around an answer, in English, German, French, Spanish, Italian and Portuguese."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

_MARKS = re.compile("[\u0300-\u036f]")


def words(text: str) -> frozenset[str]:
    """The words of a text, as a set."""
    return frozenset(text.split())


def phrases(text: str) -> frozenset[str]:
    """The same of texts with bars between them."""
    return frozenset(text.split("|"))


@lru_cache(maxsize=4096)
def plain(text: str) -> str:
    """A text in small letters, without accents, blanks around it and the stop at its end.

    >>> plain(" Non intégrable. ")
    'non integrable'
    """
    bare = _MARKS.sub("", unicodedata.normalize("NFD", text.strip().lower().replace("’", "'")))
    return " ".join(bare.rstrip(".!").split())


#: Whole numbers in words; masculine, feminine and counted forms.
NUMBERS: dict[str, int] = {
    plain(word): n
    for n, forms in enumerate((
        "zero null zéro cero nil", "one ein eins eine einen einer eines un une uno una um uma single",
        "two zwei deux dos due dois duas", "three drei trois tres tre três", "four vier quatre cuatro quattro quatro",
        "five fünf fuenf cinq cinco cinque", "six sechs seis sei", "seven sieben sept siete sette sete",
        "eight acht huit ocho otto oito", "nine neun neuf nueve nove", "ten zehn dix diez dieci dez",
        "eleven elf onze once undici", "twelve zwölf zwoelf douze doce dodici doze",
    ))
    for word in forms.split()
}  # fmt: skip
#: Nouns that say what is counted: a number of constraints is no number of degrees of freedom, and the other way round.
CONSTRAINT_NOUNS = words(
    "equation equations constraint constraints gleichung gleichungen zwangsbedingung zwangsbedingungen bindung "
    "bindungen "
    "contrainte contraintes liaison liaisons ecuacion ecuaciones restriccion restricciones ligadura ligaduras vincolo "
    "vincoli equazione equazioni vinculo vinculos equacao equacoes"
)
FREEDOM_NOUNS = words(
    "degree-of-freedom degrees-of-freedom dof dofs fhg ddl gdl gdls freedom freiheitsgrad freiheitsgrade "
    "freiheitsgraden liberte liberta libertad liberdade mobility mobilite mobilita movilidad mobilitat laufgrad"
)
#: What is counted.
UNITS = (
    words(
        "seul seule sola solo degree degrees deg of di "
        "do degre degres de d grado grados gradi grau graus "
        "coordinate coordinates koordinate koordinaten coordonnee coordonnees coordenada coordenadas "
        "coordinata independent unabhangig unabhangige independants independantes independante independiente "
        "independientes indipendenti indipendente independentes generalized generalised generalisierte "
        "verallgemeinerte velocity velocities geschwindigkeiten vitesses velocidades finite holonomic holonome total "
        "angle angles winkel angoli angulos "
        "insgesamt en tout einziger einzige einzigen in im dans nel configuration konfigurationsraum space "
        "espace espacio "
        "spazio espaco"
    )
    | CONSTRAINT_NOUNS
    | FREEDOM_NOUNS
)
#: What leads to a number.
LEADING = words(
    "it it's there the system answer has is are we have get number so thus hence therefore total das der die hat "
    "gibt es hier ist sind man wir haben anzahl antwort also le la les systeme il y a on nombre est sont reponse "
    "el los sistema tiene hay numero son respuesta che ci sono ha risposta o os tem sao resposta exactly genau "
    "exactement exactamente esattamente got only nur seulement solo of freedom degrees mechanism body particle "
    "koerper just simply think believe i c'e ce follows besitzt possede possiede possui pendulum pendel doppelpendel "
    "pendule pendolo pendulo"
)
#: After these comes a reason, which is read over.
REASONS = re.compile(
    r"\b(?:because|since|as there|due to|weil|da|denn|wegen|car|parce que|puisque|porque|ya que|pues|perche|perché|"
    r"poiche|poiché|pois|já que)\b",
    re.IGNORECASE,
)
#: Words that turn a statement round or leave it open.
NEGATIONS = words("not no nicht kein keine pas nao não non never isn't")
#: Words that take back what is said, or leave it open.
DOUBTS = words(
    "maybe perhaps possibly probably doubt doubtful doubts wrong false incorrect untrue unsure opposite contrary "
    "hardly if would could might seems seemingly looks scarcely barely "
    " unlikely anything lacks sometimes undecided rather unless except almost quasi partly partially far "
    "vielleicht eventuell moglicherweise vermutlich zweifel bezweifle falsch gegenteil kaum unwahr keineswegs "
    "bzw jein manchmal mitunter unentschieden "
    "keinesfalls fast teilweise unsicher wenn falls sofern ware konnte scheint "
    "peut-etre parfois faux fausse incorrect contraire guere presque doute incorrecte "
    "veces quizas quiza acaso incorrecto incorrecta opuesto contrario contraria dudo apenas casi tal-vez "
    "volte vezes forse falso falsa sbagliato errato opposto dubito quasi appena errada errado talvez duvido quase"
)
#: Words of a remark that take back what it follows, where there are few; and what does in any.
_TAKING_BACK = words(
    "maybe perhaps possibly probably doubtful wrong false incorrect unsure guess guessed jein vielleicht eventuell "
    "vermutlich falsch unsicher geraten peut-etre faux fausse incorrecte quizas quiza incorrecto incorrecta forse "
    "falso falsa sbagliato errato errada errado talvez"
)
_DOUBTFUL_WORDS = 3
_UNSURE = re.compile(
    r"\b(?:not|nicht|pas|no|non|nao)\s+(?:quite\s+|ganz\s+)?(?:sure?|certain|sicher|segur[oa]|sicur[oa]|cert[oa])\b"
)
#: What draws a conclusion.
CONCLUSION = re.compile(
    r"(?:[.,;]|\s)\s*(?:so|therefore|hence|thus|donc|luego|quindi|portanto|daher|folglich)\b\s*:?\s*(?=\S)",
    re.IGNORECASE,
)
#: What is answered to a word such as `holonomic:`.
YES = words("yes true ja wahr oui vrai si sim vero verdadero verdadera verdadeiro")
NO = words("no false not nein falsch nicht non faux falso falsa nao")
#: Alone they are no answer at all.
NOTHING_SAID = frozenset(
    ("", "-", "--", "---", "–", "—", "−", "/", "?", "??", "???", "...", "…", "n/a", "na", "x?", ".")
)
#: Words between words of an answer that say nothing.
FILLING = words(
    "of only just nur seulement solo solamente soltanto somente allein seul l'angle un'angolo a an the is it be "
    "also really either both these are and as for example e.g. der die das ein eine einen ist es auch und sind "
    "winkel angle angles position positions coordinate coordinates le la les un une est c'est aussi et sont el "
    "los las uno una son tambien y lo il gli i e anche sono os um uma tambem constraint constraints with to by "
    "von vom mit bindung bindungen koordinate koordinaten coordonnees coordenadas redundant redundante "
    "redundantes generalized generalised verallgemeinerte one choice possible set wir wahlen choose can dropped "
    "alone sowie beide beiden both les deux ambos entrambi allebei"
)


def takes_back(remark: str) -> bool:
    """Return whether a short remark leaves open what precedes it: `?`, `not sure`, `maybe 2`.

    >>> takes_back("not sure"), takes_back("it would be 2 without the rod")
    (True, False)
    """
    remark_words = re.findall(r"[^\W\d_]+(?:['’-][^\W\d_]+)*", plain(remark))
    doubted = len(remark_words) <= _DOUBTFUL_WORDS and not _TAKING_BACK.isdisjoint(remark_words)
    return "?" in remark or doubted or _UNSURE.search(plain(remark)) is not None


def says_nothing(answer: object) -> bool:
    """Return whether there is no answer: nothing, a dash, a question mark."""
    return isinstance(answer, str) and answer.strip().lower() in NOTHING_SAID

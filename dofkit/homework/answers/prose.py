"""The words around an answer, in English, German, French, Spanish, Italian and Portuguese."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

_MARKS = re.compile("[\u0300-\u036f]")


def words(text: str) -> frozenset[str]:
    """The words of a text, as a set."""
    return frozenset(text.split())


def _phrases(text: str) -> frozenset[str]:
    return frozenset(text.split("|"))


#: Whole numbers in words; masculine, feminine and counted forms.
NUMBERS: dict[str, int] = {
    word: n
    for n, forms in enumerate((
        "zero null zéro cero nil", "one ein eins eine einen einer eines un une uno una um uma single",
        "two zwei deux dos due dois duas", "three drei trois tres tre três", "four vier quatre cuatro quattro quatro",
        "five fünf fuenf cinq cinco cinque", "six sechs seis sei", "seven sieben sept siete sette sete",
        "eight acht huit ocho otto oito", "nine neun neuf nueve nove", "ten zehn dix diez dieci dez",
        "eleven elf onze once undici", "twelve zwölf zwoelf douze doce dodici doze",
    ))
    for word in forms.split()
}  # fmt: skip
#: What is counted.
UNITS = words(
    "seul seule sola solo degree-of-freedom degrees-of-freedom dof dofs fhg ddl gdl gdls degree degrees deg of di "
    "do freedom freiheitsgrad freiheitsgrade freiheitsgraden degre degres de d liberte liberta grado grados gradi "
    "libertad grau graus liberdade equation equations constraint constraints gleichung gleichungen "
    "zwangsbedingung zwangsbedingungen bindung bindungen contrainte contraintes liaison liaisons ecuacion "
    "ecuaciones restriccion restricciones ligadura ligaduras vincolo vincoli equazione equazioni vinculo vinculos "
    "equacao equacoes coordinate coordinates koordinate koordinaten coordonnee coordonnees coordenada coordenadas "
    "coordinata independent unabhangig unabhangige independants independantes independante independiente "
    "independientes indipendenti indipendente independentes generalized generalised generalisierte "
    "verallgemeinerte velocity velocities geschwindigkeiten vitesses velocidades finite holonomic holonome total "
    "insgesamt en tout"
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
#: What is answered to a word such as `holonomic:`.
YES = words("yes true ja wahr oui vrai si sim vero verdadero verdadera verdadeiro")
NO = words("no false not nein falsch nicht non faux falso falsa nao")
#: The answers that there is none, in small letters and without accents; a dash alone is no answer.
NONE = _phrases(
    "none|no|nope|nothing|null|nil|empty|∅|{}|[]|()|there is none|there are none|does not exist|no integral|"
    "not integrable|it does not integrate|does not integrate|doesn't integrate|it is not integrable|"
    "cannot be integrated|can't be integrated|non integrable|non-integrable|nonintegrable|no integrable|no redundant|"
    "no redundancy|not redundant|nothing is redundant|"
    "nothing can be dropped|none can be dropped|no constraint can be dropped|"
    "no integral exists|there is no such relation|none of them|none is redundant|none are redundant|"
    "no redundant constraints|no constraint|no constraints|no redundant constraint|there is no integral|"
    "no finite relation|none exists|no such relation|not possible|not holonomic|nonholonomic|non-holonomic|"
    "it is non-holonomic|it is nonholonomic|non holonomic|"
    "nein|keine|keiner|keines|keins|nichts|nicht integrierbar|ist nicht integrierbar|gibt es nicht|gibt keine|"
    "es gibt keine|es gibt keines|es gibt keins|kein integral|leer|leere menge|keine redundanten|keine redundant|"
    "keine redundante|keine redundanz|keine ist redundant|nichtholonom|nicht holonom|anholonom|existiert nicht|"
    "lasst sich nicht integrieren|nicht moglich|integriert nicht|"
    "non|aucun|aucune|rien|il n'y en a pas|il n'y en a aucune|pas integrable|n'est pas integrable|"
    "ce n'est pas integrable|n'existe pas|pas d'integrale|aucune integrale|vide|aucune redondance|"
    "aucune n'est redondante|elle n'est pas integrable|pas de redondance|non holonome|"
    "ninguno|ninguna|nada|no hay|no existe|no es integrable|vacio|no hay ninguna|no hay ninguno|"
    "ninguna es redundante|no se integra|no se puede integrar|no holonoma|"
    "nessuno|nessuna|niente|non esiste|non e integrabile|non integrabile|non ce ne sono|vuoto|anolonomo|"
    "nao|nenhum|nenhuma|nao ha|nao existe|nao e integravel|nao integravel|vazio"
)
#: What stands between the parts of an answer.
_PARTS = r"[,;:(\n]| - | – | — "
_ANDS = r"\s(?:and|und|et|y|e|but|aber|mais|pero|ma|mas)\s"
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
    "redundantes generalized generalised verallgemeinerte one choice possible set wir wahlen choose can dropped"
)


@lru_cache(maxsize=4096)
def plain(text: str) -> str:
    """A text in small letters, without accents, blanks around it and the stop at its end.

    >>> plain(" Non intégrable. ")
    'non integrable'
    """
    bare = _MARKS.sub("", unicodedata.normalize("NFD", text.strip().lower().replace("’", "'")))
    return " ".join(bare.rstrip(".!").split())


def takes_back(remark: str) -> bool:
    """Does a short remark leave open what stands before it: `?`, `not sure`, `maybe 2`?

    >>> takes_back("not sure"), takes_back("it would be 2 without the rod")
    (True, False)
    """
    told = re.findall(r"[^\W\d_]+(?:['’-][^\W\d_]+)*", plain(remark))
    doubted = len(told) <= _DOUBTFUL_WORDS and not _TAKING_BACK.isdisjoint(told)
    return "?" in remark or doubted or _UNSURE.search(plain(remark)) is not None


def says_nothing(answer: object) -> bool:
    """Is there no answer: nothing, a dash, a question mark?"""
    return isinstance(answer, str) and answer.strip().lower() in NOTHING_SAID


def says_none(text: str) -> bool:
    """Does a text say that there is none?"""
    told = plain(REASONS.split(text, maxsplit=1)[0])
    return told in NONE or plain(re.split(_PARTS, told, maxsplit=1)[0]) in NONE


def beside_none(text: str) -> list[str]:
    """The parts of a text that says in one of them that there is none; nothing where none says so, reasons left out.

    >>> beside_none("y = C x, not integrable"), beside_none("y = C x"), beside_none("none")
    (['y = C x'], [], [])
    """
    parts = [part.strip(" ()") for part in re.split(rf"{_PARTS}|{_ANDS}", REASONS.split(text, maxsplit=1)[0])]
    denied = [part for part in parts if plain(part) in NONE and re.search(r"[^\W\d_]", part)]
    return [part for part in parts if part and part not in denied] if denied else []

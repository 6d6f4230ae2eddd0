"""What was corrected, not reproduced or damaged is listed, and nothing else."""

from bookledger import Source
from bookledger.errata import listed, totals
from bookledger.statuses import STATUSES, Corrected, Damaged, NotComputable, Unreproduced

CONTENT = """
[source]
title = "Author"
citation = "A. Author"
[assumption.flow]
text = "F = 1"
parameters = 1
within = "5 %"
["Example 1"]
title = "An example"
chapter = "02_walls"
result = [
    { name = "a", printed = "1", equation = "1.2", status = "corrected", correct = "2", because = "a slip" },
    { name = "b", printed = "3", status = "unreproduced", computed = "4", because = "nobody knows", tried = "F = 1" },
    { name = "c", printed = "5", status = "reconstructed", assuming = "flow" },
    { name = "d", printed = "6", status = "measured", because = "in the laboratory" },
    { name = "e", printed = "7" },
    { name = "f", printed = "8", status = "damaged", correct = "9", because = "a bracket is lost" },
    { name = "g", about = "y", claim = "It falls.", status = "corrected", correct = "It grows.", because = "the sign" },
    { name = "h", printed = "8", status = "quoted", library = "math.pi" },
    { name = "i", printed = "8", status = "not computable", because = "no inputs" },
    { name = "j", about = "z", claim = "It is.", status = "unreproduced", computed = "N.", because = "b", tried = "a" },
    { name = "k", printed = "5", status = "fitted", assuming = "flow" },
    { name = "l", about = "a; b", claim = "It is better.", status = "divided", on = "a wall" },
    { name = "m", about = "c", claim = "It is.", says = "false", status = "not computable", because = "no inputs" },
]
misprint = [{ printed = "Section ??", correct = "Section 2", because = "a lost reference", place = "footnote" }]
damage = [{ printed = "k 1", correct = "k_1", because = "a lost index" }]
"""
BOOK = {"book": Source.read("book", CONTENT.encode())}
LINK = "([02_walls](walls/02_walls.ipynb))"
LISTED = {
    Corrected: [
        f"**Example 1, equation (1.2)**, a: prints `1`, correct is `2`: a slip. {LINK}",
        f"**Example 1** claims: It falls. It should read: It grows. Reason: the sign. {LINK}",
        f"**Example 1** prints `Section ??` (footnote) for `Section 2`: a lost reference. {LINK}",
    ],
    Unreproduced: [
        f"**Example 1**, b: prints `3`, computed is `4`: nobody knows; tried: F = 1. {LINK}",
        f"**Example 1** claims: It is. We found: N. Reason: b; tried: a. {LINK}",
    ],
    NotComputable: [
        f"**Example 1**, i, `8`: no inputs. {LINK}",
        f"**Example 1** denies: It is. Reason: no inputs. {LINK}",
    ],
    Damaged: [
        f"**Example 1**, f: reads `8`, correct is `9`: a bracket is lost. {LINK}",
        f"**Example 1** prints `k 1` for `k_1`: a lost index. {LINK}",
    ],
}


def test_each_status_has_its_list():
    for status, lines in LISTED.items():
        assert listed(BOOK, status, "walls/") == "\n".join(["## A. Author\n", *(f"- {line}" for line in lines), ""])
        assert listed({"book": Source.read("book", CONTENT.partition('["')[0].encode())}, status, "") == ""


def test_totals_count_each_result_once():
    once = dict.fromkeys(STATUSES, 1) | {"corrected": 2, "unreproduced": 2, "not computable": 2, "observed": 0}
    assert totals(BOOK) == {"book": once}

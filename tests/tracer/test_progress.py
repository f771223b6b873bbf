"""The share of a work from the shares of its parts."""

from tracer.progress import divided


def test_parts_count_as_much_as_they_cost() -> None:
    told: list[float] = []
    first, second, third = divided(told.append, [1.0, 0.0, 3.0])
    for part, share in ((first, 0.5), (first, 1.0), (second, 1.0), (third, 0.5), (third, 1.0)):
        part(share)
    assert told == [0.125, 0.25, 0.25, 0.625, 1.0]


def test_parts_without_a_cost_are_equal() -> None:
    told: list[float] = []
    for part in divided(told.append, [0.0, 0.0]):
        part(1.0)
    assert told == [0.5, 1.0]

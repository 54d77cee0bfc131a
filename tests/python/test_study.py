"""Studies: error against run time from Python."""

import math

import pytest

import culbuto
from culbuto.study import thrown_ball


def errors(study: culbuto.Study) -> list[float]:
    return [row.error for row in study.rows]


def test_a_study_has_a_row_for_each_run() -> None:
    study = culbuto.study(
        "kepler",
        steps=[1 / 60, 1 / 240],
        tolerances=[1e-6, 1e-9],
        methods=["leapfrog", "dop853"],
        repeats=1,
    )
    runs = [(row.method, row.step is None, row.tolerance) for row in study.rows]
    assert runs == [
        ("leapfrog", False, None),
        ("leapfrog", False, None),
        ("dop853", False, None),
        ("dop853", False, None),
        ("dop853", True, 1e-6),
        ("dop853", True, 1e-9),
    ]
    # Steps are the nearest that divide the run.
    assert study.rows[0].step == pytest.approx(math.tau / 377, rel=1e-12)
    assert all(row.seconds > 0 and row.evaluations > 0 for row in study.rows)
    assert study.rows[5].error < study.rows[4].error


def test_errors_are_the_same_bits_every_time() -> None:
    first, second = (culbuto.study("fall_with_drag", steps=[0.1, 0.01], repeats=1) for _ in "12")
    assert errors(first) == errors(second)


def test_measured_orders_are_the_stated_ones() -> None:
    study = culbuto.study("kepler", steps=[0.1], tolerances=[], repeats=1)
    assert list(study.order) == [facts.name for facts in culbuto.methods()]
    for order in study.order.values():
        assert order.exact or abs((order.measured or 0) - order.stated) < 0.2


def test_the_closed_form_has_a_row_of_its_own() -> None:
    study = culbuto.study("S1", steps=[0.1], tolerances=[], methods=["leapfrog"], repeats=1)
    assert study.methods == ["closed_form", "leapfrog"]
    assert "closed_form" not in study.order
    assert study.curve("closed_form")[0].error < 1e-15


def test_the_table_is_columns_of_equal_length() -> None:
    study = culbuto.study("S12", steps=[0.1, 0.05], tolerances=[], methods=["rk4"], repeats=1)
    assert study.table["method"] == ["rk4", "rk4"]
    assert {len(column) for column in study.table.values()} == {2}
    assert len(repr(study.table).splitlines()) == 3


def test_a_plot_has_a_line_for_each_curve() -> None:
    pytest.importorskip("matplotlib")
    study = culbuto.study("S12", steps=[0.1, 0.05], tolerances=[1e-6], repeats=1)
    ax = study.plot()
    # One for each method, and the one to tolerances.
    assert len(ax.get_lines()) == len(culbuto.methods()) + 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"scene": "nothing"}, "allowed: projectile"),
        ({"scene": "polygons"}, "a motion"),
        ({"scene": "S1", "steps": [0]}, "a step is 0"),
        ({"scene": "S1", "steps": [math.nan]}, "a step is nan"),
        ({"scene": "S1", "methods": ["magic"]}, "leapfrog"),
        ({"scene": "S1", "repeats": 0}, "repeats is 0"),
    ],
)
def test_says_what_is_wrong(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        culbuto.study(**arguments)  # type: ignore[arg-type]


def test_a_thrown_ball_is_off_by_half_g_h_t() -> None:
    [path] = thrown_ball(["explicit_euler"], [10])
    assert len(path.points) == 21
    # Explicit Euler at t = 2 with h = 0.1: ½ght too high.
    assert path.points[-1] == pytest.approx((24, -0.12 + 0.5 * 9.81 * 0.1 * 2), rel=1e-12)


def test_laws_of_a_world_leave_it_as_it_is() -> None:
    world = culbuto.scene("S12")
    laws = culbuto.verify_laws(world, dt=0.01, duration=1)
    assert world.time == 0
    assert laws.passed
    energy, momentum, *_ = laws.laws
    assert energy.measured is not None
    assert momentum.measured is None  # an outside field acts
    strict = culbuto.Limits(energy=0.0)
    assert not culbuto.verify_laws(world, dt=0.01, duration=1, limits=strict).passed

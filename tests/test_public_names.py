"""Names of the package: those that have changed still work, with a warning."""

import pytest

import iiwa_dnn


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("CentreOfMassTask", iiwa_dnn.CenterOfMassTask),
        ("RemoteCentreTask", iiwa_dnn.RemoteCenterTask),
    ],
)
def test_an_old_name_is_the_new_one_with_a_warning(old: str, new: type) -> None:
    with pytest.warns(DeprecationWarning, match=new.__name__):
        assert getattr(iiwa_dnn, old) is new
    assert old not in iiwa_dnn.__all__


def test_an_unknown_name_is_an_attribute_error() -> None:
    assert not hasattr(iiwa_dnn, "CentreOfEverything")
    assert set(iiwa_dnn.__all__) <= set(vars(iiwa_dnn))

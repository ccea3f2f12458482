"""Names of the package: those that have changed still work, with a warning."""

import numpy as np
import pytest

import iiwa_dnn
from helpers_simulation import paper_start


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


def test_the_old_property_is_the_new_one_with_a_warning() -> None:
    conf = paper_start()
    with pytest.warns(DeprecationWarning, match="center_of_mass"):
        position, jacobian = conf.centre_of_mass
    np.testing.assert_array_equal(position, conf.center_of_mass[0])
    np.testing.assert_array_equal(jacobian, conf.center_of_mass[1])


def test_an_unknown_name_is_an_attribute_error() -> None:
    assert not hasattr(iiwa_dnn, "CentreOfEverything")
    assert set(iiwa_dnn.__all__) <= set(vars(iiwa_dnn))

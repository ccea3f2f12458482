"""Names of the package."""

import iiwa_dnn


def test_an_unknown_name_is_an_attribute_error() -> None:
    assert not hasattr(iiwa_dnn, "CentreOfEverything")
    assert set(iiwa_dnn.__all__) <= set(vars(iiwa_dnn))

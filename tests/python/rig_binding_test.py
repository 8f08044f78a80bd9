# SPDX-License-Identifier: BSD-3-Clause
import json

import numpy as np
import pytest

import aphotic

try:
    import tomllib
except ImportError:  # before Python 3.11
    tomllib = None


def test_a_rig_is_what_its_file_says(rig_file):
    rig = aphotic.Rig.load(rig_file)
    assert (rig.width_px, rig.height_px) == (48, 36)
    assert rig.altitude_m == rig["sled.altitude_m"] == 2.0
    assert rig.text == rig_file.read_text()
    assert len(rig.strobes) == 4
    assert aphotic.Rig.parse(rig.text).digest == rig.digest


def test_a_rig_with_two_cameras_is_read_as_one_of_them(rig_file, tmp_path):
    text = rig_file.read_text()
    first, end = text.index("[camera]"), text.index("[water]")
    keys = text[first:end].removeprefix("[camera]")
    cameras = "".join(
        f'[[camera]]\nname = "{name}"\nposition_m = [0, {y}, 0]{keys}' for name, y in (("port", -0.1), ("starboard", 0.1))
    )
    stereo = tmp_path / "stereo.toml"
    stereo.write_text(text[:first] + cameras + text[end:])
    assert "position_m = [0.5, 0.0, 0.0]" in aphotic.Rig.load(stereo, camera="port").text
    assert "position_m = [0.5, -0.2, 0.0]" in aphotic.Rig.load(stereo, camera="starboard").text
    with pytest.raises(aphotic.InputError, match="allowed: one of them, by --camera port or starboard"):
        aphotic.Rig.load(stereo)


def test_replace_sets_keys_and_leaves_the_rig_alone(rig_file):
    rig = aphotic.Rig.load(rig_file)
    strobe = f"strobe.{rig.strobes[0]}"
    other = rig.replace(
        **{"sled.altitude_m": 2.5, "seafloor.reflectance": "sand", f"{strobe}.position_m": [1, 0, 0.5]}
    )
    assert (rig.altitude_m, other.altitude_m) == (2.0, 2.5)
    assert other.digest != rig.digest
    if tomllib:
        assert tomllib.loads(other.text)["strobe"][0]["position_m"] == [1, 0, 0.5]
    assert other.replace(**{"sled.altitude_m": 2.0}).altitude_m == 2.0


def test_a_saved_rig_is_the_same(rig_file, tmp_path):
    rig = aphotic.Rig.load(rig_file).replace(**{"sled.pitch_deg": 3.5})
    rig.save(tmp_path / "other.toml")
    assert aphotic.Rig.load(tmp_path / "other.toml").digest == rig.digest
    assert rig.pitch_deg == pytest.approx(3.5, abs=1e-14)


def test_errors_are_exceptions_with_the_same_words(rig_file, tmp_path, command):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(rig_file.read_text().replace("altitude_m", "altitud_m"))
    said = command("plan", wrong, status=2).stderr
    with pytest.raises(aphotic.InputError) as error:
        aphotic.Rig.load(wrong)
    assert said == f"aphotic: {error.value}\n"
    assert isinstance(error.value, ValueError)
    assert issubclass(aphotic.RunError, RuntimeError)


def test_bad_values_are_refused(rig_file):
    rig = aphotic.Rig.load(rig_file)
    with pytest.raises(aphotic.InputError, match="sled.altitude_m: found -1; allowed"):
        rig.replace(**{"sled.altitude_m": -1})
    with pytest.raises(aphotic.InputError, match="allowed: a number, a string"):
        rig.replace(**{"sled.altitude_m": {"a": 1}})
    with pytest.raises(aphotic.InputError, match="no-such"):
        rig.replace(**{"strobe.no-such.power": 1.0})
    with pytest.raises(KeyError):
        rig["sled.no_such"]


def test_spectra_are_the_commands_tables(command):
    tables = aphotic.spectra()
    listed = json.loads(command("data", "--json").stdout)
    assert sorted(tables) == sorted(one["name"] for one in listed)
    sand = json.loads(command("data", "sand", "--json").stdout)
    assert tables["sand"].columns == sand["columns"]
    assert tables["sand"].metadata == sand["metadata"]
    np.testing.assert_array_equal(tables["sand"].values, sand["values"])

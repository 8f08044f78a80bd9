# SPDX-License-Identifier: BSD-3-Clause
import json
import locale
import subprocess

import numpy as np
import OpenEXR
import pytest
from PIL import Image

import aphotic

LEVELS = {"bayer": "RGGB", "black_level": 64, "white_level": 4095}
# The stated error of two maps, whose tables are not of the same paths, and the rounding of floats.
MAP_ERROR = 3e-5
LEVEL_WORDS = ["--bayer", "RGGB", "--black-level", 64, "--white-level", 4095]


@pytest.fixture
def survey(rig_file, tmp_path, command):
    """Raw images of floats, and a navigation by which all are of one level pose.

    The command reads integers as shares of their range, and back: off by a rounding.
    """
    command("survey", rig_file, "--images", 3, "-o", "survey")
    raw = []
    for file in sorted((tmp_path / "survey/raw").iterdir()):
        raw.append(tmp_path / f"{file.stem}.exr")
        planes = {"Y": np.array(Image.open(file)).astype(np.float32)}
        with OpenEXR.File({"type": OpenEXR.scanlineimage}, planes) as image:
            image.write(str(raw[-1]))
    pose = tmp_path / "pose.csv"
    rows = [f"{file.name},2,0,0" for file in raw]
    pose.write_text("\n".join(["image,altitude_m,pitch_deg,roll_deg", *rows]) + "\n")
    return raw, pose


SETTINGS = {"gain": [1e-3] * 3, "middle": 0.3, "read_noise": 2, "electrons": 3}
SETTING_WORDS = [
    "--gain", 0.001, "--middle", 0.3, "--read-noise", 2, "--electrons", 3,
    "--mask", "--format", "exr",
]  # fmt: skip


def mask_beside(file):
    return np.array(Image.open(next(file.parent.glob(f"**/{file.stem}*mask*.png"))))


def test_an_image_by_a_map_is_the_commands_to_the_bit(rig_file, tmp_path, command, channels, survey):
    raw, _ = survey
    command("lightmap", rig_file, "-o", "map.exr")
    command("correct", *raw, "--map", "map.exr", *LEVEL_WORDS, *SETTING_WORDS, "-o", "corrected")
    light = aphotic.lightmap(aphotic.Rig.load(rig_file))
    for file in raw:
        corrected = aphotic.correct(channels(file)["Y"], light, **LEVELS, **SETTINGS, edge_px=0)
        result = tmp_path / f"corrected/{file.stem}.exr"
        for c, name in enumerate("RGB"):
            np.testing.assert_array_equal(corrected.image[:, :, c], channels(result)[name])
        np.testing.assert_array_equal(corrected.doubts, mask_beside(result))


def test_an_image_by_its_pose_is_the_commands(rig_file, tmp_path, command, channels, survey):
    raw, pose = survey
    command(
        "correct", *raw, "--rig", rig_file, "--nav", pose, *LEVEL_WORDS, *SETTING_WORDS,
        "-o", "corrected",
    )  # fmt: skip
    level = aphotic.Rig.load(rig_file).replace(**{"sled.pitch_deg": 0.0, "sled.roll_deg": 0.0})
    light = aphotic.LightmapMaker(level).map()
    for file in raw:
        corrected = aphotic.correct(channels(file)["Y"], light, **LEVELS, **SETTINGS)
        result = tmp_path / f"corrected/{file.stem}.exr"
        for c, name in enumerate("RGB"):
            np.testing.assert_allclose(
                corrected.image[:, :, c], channels(result)[name], rtol=MAP_ERROR
            )
        np.testing.assert_array_equal(corrected.doubts, mask_beside(result))


def test_an_image_of_the_map_comes_out_flat(rig_file):
    """raw = E (map + veil), so that corrected = g E where the map is bright: one number a channel."""
    light = aphotic.lightmap(aphotic.Rig.load(rig_file))
    exposure = 1e3 / light.floor.max()
    corrected = aphotic.correct(exposure * light.signal, light, middle=0.5, edge_px=0)
    good = corrected.doubts == 0
    assert good.sum() > 500
    rounding = 1e-6  # of floats, a few
    np.testing.assert_allclose(corrected.image[good], 0.5, rtol=rounding)


def test_bad_images_are_refused(rig_file):
    light = aphotic.lightmap(aphotic.Rig.load(rig_file))
    with pytest.raises(aphotic.InputError, match="like the map"):
        aphotic.correct(np.ones((10, 10), np.float32), light, bayer="RGGB")
    with pytest.raises(aphotic.InputError, match="bayer: found 'RGBG'"):
        aphotic.correct(np.ones((36, 48), np.float32), light, bayer="RGBG")
    with pytest.raises(aphotic.InputError, match="raw: found 2 dimensions"):
        aphotic.correct(np.ones((36, 48), np.float32), light)
    with pytest.raises(aphotic.InputError, match="allowed: with a gain"):
        aphotic.correct(np.zeros((36, 48), np.float32), light, bayer="RGGB")


@pytest.fixture
def flight(rig_file, tmp_path, command):
    """What a fit of a survey of twelve images takes, and the same as words for the command."""
    command("survey", rig_file, "--images", 12, "-o", "survey")
    images, nav = str(tmp_path / "survey/raw"), tmp_path / "survey/navigation-measured.txt"
    words = ["--images", images, "--nav", nav, *LEVEL_WORDS, "--blocks", 12]
    return {"images": [images], "nav": nav, **LEVELS, "blocks": 12}, words


@pytest.mark.parametrize(
    ("words", "options"),
    [
        (
            ["--free", "beam,aim,power,vignetting", "--hold", "strobe.aft.power,strobe.fore.aim_along_deg",
             "--prior", "aim=1deg,power=0.2", "--vignetting", "radial"],
            {"free": ["beam", "aim", "power", "vignetting"],
             "hold": ["strobe.aft.power", "strobe.fore.aim_along_deg"],
             "priors": {"aim": 1, "power": 0.2}, "vignetting": "radial"},
        ),
        (
            ["--hold", "water,vignetting", "--beam", "cones", "--beam-each"],
            {"hold": ["water", "vignetting"], "beam": "cones", "beam_each": True},
        ),
    ],
)  # fmt: skip
def test_a_fit_is_the_commands(rig_file, tmp_path, command, flight, words, options):
    survey, survey_words = flight
    said = json.loads(
        command("fit", rig_file, *survey_words, *words, "-o", "fitted", "--json").stdout
    )
    fit = aphotic.fit(aphotic.Rig.load(rig_file), **survey, **options)
    assert json.loads(fit.json) == said
    numbers = [
        {
            "key": one.key,
            "start": one.start,
            "value": one.value,
            "error": one.error,
            "prior": one.prior,
            "determined": one.is_determined,
        }
        for one in fit.numbers
    ]
    for one in said["numbers"]:
        one.pop("fly_at", None)
    assert numbers == said["numbers"]
    assert fit.unevenness == said["expected_unevenness"]
    assert fit.looks_wrong == [(one["about"], one["what"]) for one in said["looks_wrong"]]
    saved = fit.save(tmp_path / "by-python")
    assert saved.text == (tmp_path / "fitted/fitted.toml").read_text()


def test_a_survey_does_not_determine_what_is_known_better(rig_file, flight):
    """Of a thousandth of a degree twelve images know nothing; of the other aims they do."""
    known = "strobe.fore.aim_along_deg"
    fit = aphotic.fit(
        aphotic.Rig.load(rig_file),
        **flight[0],
        free=["beam", "aim"],
        beam="cones",
        priors={known: 1e-3},
    )
    lacking = [one.key for one in fit.numbers if not one.is_determined]
    assert [key for key in lacking if "aim" in key] == [known]
    assert [text.split()[0] for text in fit.not_determined] == lacking


def test_a_fit_tells_what_it_skips(rig_file, tmp_path, flight):
    survey, _ = flight
    lines = survey["nav"].read_text().splitlines()
    lines[-1] = "000012.tif,none,0,0"
    survey["nav"].write_text("\n".join(lines) + "\n")
    with pytest.warns(UserWarning, match="000012.tif: .*; skipped"):
        fit = aphotic.fit(aphotic.Rig.load(rig_file), **survey, free=["power"])
    assert [image for image, _ in fit.skipped] == [str(tmp_path / "survey/raw/000012.tif")]
    assert all(why for _, why in fit.skipped + fit.looks_wrong)


def test_no_locale_of_the_host_changes_a_number(rig_file, tmp_path, monkeypatch):
    made = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", tmp_path / "de_DE.UTF-8"],
        capture_output=True,
        check=False,
    )
    if made.returncode != 0:
        pytest.skip("no locale with decimal commas can be made here")
    expected = aphotic.Rig.load(rig_file).replace(**{"sled.altitude_m": 2.5})
    monkeypatch.setenv("LOCPATH", str(tmp_path))
    before = locale.setlocale(locale.LC_ALL)
    locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
    try:
        assert locale.str(2.5) == "2,5"
        rig = aphotic.Rig.load(rig_file).replace(**{"sled.altitude_m": 2.5})
        assert rig.text == expected.text
        assert rig.digest == expected.digest
        assert rig.altitude_m == 2.5
        np.testing.assert_array_equal(
            aphotic.lightmap(rig).floor, aphotic.lightmap(expected).floor
        )
    finally:
        locale.setlocale(locale.LC_ALL, before)


def test_a_fit_says_what_it_needs(rig_file):
    rig = aphotic.Rig.load(rig_file)
    with pytest.raises(aphotic.InputError, match="found neither maps nor images"):
        aphotic.fit(rig)
    with pytest.raises(aphotic.InputError, match="images: found no navigation"):
        aphotic.fit(rig, images=["."])
    wrong = [
        ({"beam": "square"}, "beam: found square"),
        ({"vignetting": "square"}, "vignetting: found square"),
        ({"beam": "cones", "free": ["power"]}, "beam: found with a beam that is not fitted"),
        ({"beam_each": True, "free": ["power"]}, "beam: found with a beam that is not fitted"),
        ({"priors": {"aim": 0}}, "--prior: found 0 of aim"),
        ({"priors": {"aim": float("inf")}}, "--prior: found inf of aim"),
        ({"priors": {"aim": float("nan")}}, "--prior: found nan of aim"),
    ]
    for options, words in wrong:
        with pytest.raises(aphotic.InputError, match=words):
            aphotic.fit(rig, maps=["a.exr"], **options)

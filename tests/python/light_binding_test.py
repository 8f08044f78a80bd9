# SPDX-License-Identifier: BSD-3-Clause
import gc
import json
import re
import sys
import threading

import numpy as np
import pytest

import aphotic
from conftest import SOURCE

CHANNELS = "RGB"
# The stated error of two maps, and the rounding of floats.
MAP_ERROR = 3e-5


def in_coastal_water(rig):
    return rig.replace(
        **{
            "water.absorption": None,
            "water.multiple": None,
            "water.type": "jerlov-3C",
            "camera.range_nm": [400, 700],
        }
    )


def test_a_lightmap_is_the_commands_to_the_bit(rig_file, tmp_path, command, channels):
    rig = aphotic.Rig.load(rig_file)
    command("lightmap", rig_file, "-o", "map.exr", "--per-strobe")
    planes = channels(tmp_path / "map.exr")
    light = aphotic.lightmap(rig, per_strobe=True)
    assert light.veil is None
    assert light.floor.shape == (36, 48, 3) and light.floor.dtype == np.float32
    for c, name in enumerate(CHANNELS):
        np.testing.assert_array_equal(light.floor[:, :, c], planes[name])
        np.testing.assert_array_equal(getattr(light, name), planes[name])
        np.testing.assert_array_equal(light.signal[:, :, c], planes[name])
        for strobe in rig.strobes:
            np.testing.assert_array_equal(
                getattr(light.strobes[strobe], name), planes[f"{strobe}.{name}"]
            )
    assert sorted(light.strobes) == sorted(rig.strobes)


def test_a_veil_is_the_commands_to_the_bit(rig_file, tmp_path, command, channels):
    rig = in_coastal_water(aphotic.Rig.load(rig_file))
    rig.save(tmp_path / "coast.toml")
    command("lightmap", "coast.toml", "-o", "map.exr", "--model-tolerance", "1e9")
    planes = channels(tmp_path / "map.exr")
    light = aphotic.lightmap(rig)
    for c, name in enumerate(CHANNELS):
        np.testing.assert_array_equal(light.veil[:, :, c], planes[f"veil.{name}"])
    np.testing.assert_array_equal(light.signal, light.floor + light.veil)
    assert aphotic.lightmap(rig, veil=False).veil is None
    command("lightmap", "coast.toml", "-o", "coarse.exr", "--tolerance", "0.01", "--model-tolerance", "1e9")
    coarse = channels(tmp_path / "coarse.exr")
    by_tolerance = aphotic.lightmap(rig, tolerance=0.01)
    np.testing.assert_array_equal(by_tolerance.veil[:, :, 1], coarse["veil.G"])
    assert (by_tolerance.veil != light.veil).any()


def test_arrays_are_views_that_outlive_their_map(rig_file):
    light = aphotic.lightmap(aphotic.Rig.load(rig_file))
    floor, green = light.floor, light.G
    assert np.shares_memory(floor, green)
    before = floor.copy()
    del light
    gc.collect()
    np.testing.assert_array_equal(floor, before)


def test_a_maker_maps_other_poses_and_places(rig_file):
    rig = aphotic.Rig.load(rig_file)
    maker = aphotic.LightmapMaker(rig, altitudes_m=[1.5, 3.0])
    higher = rig.replace(**{"sled.altitude_m": 2.5, "sled.roll_deg": 2.0})
    np.testing.assert_allclose(
        maker.map(altitude_m=2.5, roll_deg=2.0).floor, aphotic.lightmap(higher).floor, rtol=MAP_ERROR
    )
    key = f"strobe.{rig.strobes[0]}.power"
    other = rig.replace(**{key: 0.5})
    maker.place(other)
    np.testing.assert_allclose(maker.map().floor, aphotic.lightmap(other).floor, rtol=MAP_ERROR)
    own = aphotic.LightmapMaker(rig)
    np.testing.assert_allclose(own.map().floor, aphotic.lightmap(rig).floor, rtol=MAP_ERROR)
    with pytest.raises(aphotic.InputError, match="the image sees paths longer than the tables cover"):
        own.map(altitude_m=3.0)


def test_a_plan_is_the_commands(rig_file, command):
    rig = aphotic.Rig.load(rig_file)
    for options, words in (
        ({}, []),
        ({"tolerance": 1e-3}, ["--tolerance", "1e-3"]),
        ({"fitted": 4}, ["--fitted", "4"]),
        ({"wavelengths_nm": [478, 576, 638]}, ["--wavelengths", "478,576,638"]),
        ({"bands": 6}, ["--bands", "6"]),
    ):
        json_plan = json.loads(command("plan", rig_file, "--json", *words).stdout)
        plan = aphotic.plan(rig, **options)
        ours = json_plan["wavelengths"]
        np.testing.assert_array_equal(plan.wavelengths_nm, [w["lambda_nm"] for w in ours])
        np.testing.assert_array_equal(plan.weights, [w["weight"] for w in ours])
        assert plan.frames == json_plan["frames"]
        assert list(plan.paths_m) == json_plan["paths_m"]


def test_a_trace_is_the_commands_to_the_bit(rig_file, tmp_path, command, channels):
    command("trace", rig_file, "-o", "traced", "--wavelengths", "550")
    planes = channels(tmp_path / "traced/image.exr")
    traced = aphotic.trace(aphotic.Rig.load(rig_file), wavelengths_nm=[550])
    for c, name in enumerate(CHANNELS):
        np.testing.assert_array_equal(traced.signal[:, :, c].astype(np.float32), planes[name])
    assert traced.radiance.shape == (36, 48, 1)
    report = json.loads((tmp_path / "traced/trace.json").read_text())
    assert traced.on_edges.sum() == report["on_edges"]
    # Off the edges two programs that share no light agree.
    light = aphotic.lightmap(aphotic.Rig.load(rig_file))
    smooth = ~traced.on_edges
    np.testing.assert_allclose(light.floor[smooth], traced.signal[smooth], rtol=MAP_ERROR)


def test_bad_options_are_refused(rig_file):
    rig = aphotic.Rig.load(rig_file)
    with pytest.raises(aphotic.InputError, match="fitted: found 0; allowed: 1 to 48"):
        aphotic.plan(rig, fitted=0)
    with pytest.raises(aphotic.InputError, match="tolerance: found nan"):
        aphotic.plan(rig, tolerance=float("nan"))
    with pytest.raises(aphotic.InputError, match="allowed: one of them"):
        aphotic.plan(rig, fitted=3, bands=3)
    with pytest.raises(aphotic.InputError, match="error: found 0; allowed"):
        aphotic.lightmap(rig, error=0)
    with pytest.raises(aphotic.InputError, match="threads: found -1"):
        aphotic.trace(rig, threads=-1)
    with pytest.raises(aphotic.InputError, match="allowed: one of both"):
        aphotic.trace(rig, signals=False)
    maker = aphotic.LightmapMaker(rig)
    with pytest.raises(aphotic.InputError, match="altitude_m: found 0; allowed"):
        maker.map(altitude_m=0)


def test_others_run_meanwhile(rig_file):
    """Who holds the lock keeps it: no thread is made to hand it over, but those who compute do."""
    rig = aphotic.Rig.load(rig_file)
    most_calls = 300
    calls = 0
    stop = False

    def work():
        nonlocal calls
        while not stop and calls < most_calls:
            aphotic.lightmap(rig)
            calls += 1

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    try:
        thread = threading.Thread(target=work)
        thread.start()
        stop = True
        thread.join()
    finally:
        sys.setswitchinterval(interval)
    assert calls < most_calls


def test_the_manuals_example_runs(monkeypatch, capsys):
    manual = (SOURCE / "docs/guides/python.md").read_text()
    example = re.search(r"```python\n(.*?)```", manual, re.S).group(1)
    assert len(example.strip().splitlines()) <= 10
    monkeypatch.chdir(SOURCE)
    exec(compile(example, "docs/guides/python.md", "exec"), {})
    assert len(capsys.readouterr().out.splitlines()) == 4

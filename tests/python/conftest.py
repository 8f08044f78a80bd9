# SPDX-License-Identifier: BSD-3-Clause
"""What the module's answers are held against: the command's own, for the same rig."""

import os
import pathlib
import re
import subprocess

import numpy as np
import OpenEXR
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def small(text):
    """HabCam's view in 48 x 36 pixels."""
    text = re.sub(r"\n\s*resolution\s*=[^\n]*", "\nresolution = [48, 36]", text)
    return re.sub(r"\n\s*pixel_pitch_um\s*=[^\n]*", "\npixel_pitch_um = 182.75", text)


@pytest.fixture
def rig_file(tmp_path):
    file = tmp_path / "rig.toml"
    file.write_text(small((SOURCE / "scenes/habcam.toml").read_text()))
    return file


@pytest.fixture
def command(tmp_path):
    """aphotic(ARGUMENTS) in the test's folder; the ended process."""

    def run(*arguments, status=0):
        ended = subprocess.run(
            [os.environ["APHOTIC_COMMAND"], *map(str, arguments)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert ended.returncode == status, ended.stderr
        return ended

    return run


@pytest.fixture
def channels():
    """The planes of an OpenEXR file by name, as another reader than ours has them."""

    def read(file):
        with OpenEXR.File(str(file), separate_channels=True) as image:
            return {name: np.array(plane.pixels) for name, plane in image.channels().items()}

    return read

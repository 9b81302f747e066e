"""Jobs of pictures of links: what they return, when they fail, and that nobody waits in vain."""

from __future__ import annotations

import asyncio
from io import BytesIO

import pytest
from PIL import Image

from app.job_clients import link_picture_jobs
from app.job_clients.link_picture_jobs import NotCompiledError, PngFile, link_picture_job, result_of
from app.state.link_picture import LinkPicture, picture_of
from engine import CASES
from engine.jobs.manager import Jobs
from engine.potentials.system import TYPED
from engine.warmup import prepare_for_maps
from tests.app.other_loop import run_on_new_loop
from tests.engine.jobs.inbox import wait_until_idle

PICTURE = picture_of({"case": "I", "energy": 0.3, "t_max": 100.0})
LONG = picture_of({"case": "III", "energy": 0.2})


@pytest.fixture(scope="module", autouse=True)
def _kernels() -> None:
    for case in ("I", "III"):
        prepare_for_maps(CASES[case])


def result(jobs: Jobs, picture: LinkPicture) -> PngFile:
    return run_on_new_loop(lambda: result_of(jobs, link_picture_job(picture), "client"))


def test_the_result_is_a_png_file() -> None:
    file = result(Jobs(), PICTURE)
    assert Image.open(BytesIO(file.content)).format == "PNG"
    assert file.nbytes == len(file.content)


def test_equal_pictures_are_computed_once() -> None:
    jobs = Jobs()
    assert result(jobs, PICTURE) is result(jobs, picture_of({"case": "I", "energy": 0.3, "t_max": 100.0, "trust": True}))


def test_an_invalid_view_fails_with_its_reason() -> None:
    with pytest.raises(ValueError, match="Ignored h=-1"):
        result(Jobs(), picture_of({"energy": -1.0}))


def test_nothing_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_picture_jobs, "run_map", None)
    with pytest.raises(NotCompiledError):
        result(Jobs(), picture_of({"case": TYPED, "formula": "½(x² + y²) − x²y + 0.01x^7 + 0.013x^6*y^3"}))


def test_a_picture_for_which_nobody_waits_is_cancelled() -> None:
    jobs = Jobs()

    async def give_up() -> None:
        task = asyncio.create_task(result_of(jobs, link_picture_job(LONG), "client"))
        while not jobs.in_flight:
            await asyncio.sleep(0)
        task.cancel()
        await asyncio.wait([task])

    run_on_new_loop(give_up)
    assert jobs.in_flight == 0
    # The manager counts a job when its computation has ended.
    wait_until_idle(jobs)
    jobs.stop()

"""The amount of compiled code is limited, because code is never unloaded."""

from __future__ import annotations

from collections.abc import Hashable

import pytest

from engine import POTENTIALS
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.compiled_operations import (
    LARGEST_CODE,
    SHARES,
    CompiledCodeLimitError,
    CompiledOperations,
    charged_to,
    compiled_operations,
)
from engine.integrator.source.recurrence import find_structure, outline_code
from engine.integrator.source.series import Setting
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.maps.warmup import reserve_catalogue
from tests.engine.jobs.inbox import Inbox
from tests.waiting import SECONDS

MOST = 1000
SHARE = MOST // SHARES


@pytest.fixture
def limited() -> CompiledOperations:
    """Return an account of compiled code with a limit of `MOST` operations."""
    limited = CompiledOperations()
    limited.limit = MOST
    return limited


def test_compilation_beyond_the_limit_is_refused_with_a_sentence() -> None:
    terms = ((2, 0, 0.5), (0, 2, 0.5), (9, 0, 1.0))
    compiled_operations.limit = 1
    with pytest.raises(ValueError, match="choose a potential with the same powers"):
        load_kernels(terms, Setting())
    compiled_operations.limit = None
    assert load_kernels(terms, Setting()).potential_value(1.0, 1.0) == 2.0
    assert compiled_operations.used == outline_code(find_structure(terms, Setting())).operations


def test_reserved_code_is_compiled_at_the_limit_and_does_not_count(limited: CompiledOperations) -> None:
    limited.reserve(["reserved"])
    limited.add("first", MOST)
    limited.add("reserved", 2 * LARGEST_CODE)
    assert limited.used == MOST
    # This code was compiled before it was reserved.
    limited.reserve(["first"])
    assert limited.used == 0


def test_a_code_that_is_too_large_is_refused_where_there_is_a_limit() -> None:
    operations = CompiledOperations()
    operations.add("large", LARGEST_CODE + 1)
    operations.limit = 10 * LARGEST_CODE
    operations.add("less", LARGEST_CODE)
    with pytest.raises(CompiledCodeLimitError, match=f"has {LARGEST_CODE + 1} operations, and at most {LARGEST_CODE}"):
        operations.add("other", LARGEST_CODE + 1)


def test_an_account_has_a_share_of_the_limit(limited: CompiledOperations) -> None:
    with charged_to("one"):
        limited.add("first", SHARE)
        with pytest.raises(CompiledCodeLimitError, match="your address"):
            limited.add("second", 1)
    with charged_to("other"):
        limited.add("second", SHARE)
    # This code has no account.
    limited.add("third", 2 * SHARE)
    assert limited.used == MOST


@pytest.mark.parametrize(("account", "is_refused"), [("one", True), (None, False)])
def test_a_job_takes_the_share_of_its_client(account: Hashable, is_refused: bool) -> None:
    terms = ((2, 0, 0.5), (0, 2, 0.5), (3, 6, 1.0 if account else 2.0), (6, 3, 1.0))
    compiled_operations.limit = SHARES * outline_code(find_structure(terms, Setting())).operations - 1
    client, inbox = JobClient(Jobs(), account=account), Inbox()
    client.request(Job(load_kernels, (terms, Setting()), queue=Queue.COMPILATION), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    assert ["your address" in str(error) for error in inbox.errors] == [True] * is_refused


def test_the_catalogue_can_be_compiled_even_at_the_limit(limited: CompiledOperations) -> None:
    potential = POTENTIALS["Copenhagen"].in_well_units
    limited.add("of others", MOST)
    code = outline_code(potential.well.structure)
    with pytest.raises(CompiledCodeLimitError):
        limited.add(code.digest, code.operations)
    reserve_catalogue(limited)
    limited.add(code.digest, code.operations)

"""The executor of campaigns on Dask: errors of its client."""

from __future__ import annotations

import pytest
from flexsc import Scenario


def test_a_client_that_closes_between_two_checks_is_a_lost_scheduler(sampled: Scenario) -> None:
    class Closed:
        """A client that has given up its scheduler: it takes no tasks any more."""

        status = "closed"

        def nthreads(self) -> dict[str, int]:
            return {"worker": 1}

        def submit(self, *_: object, **__: object) -> None:
            raise RuntimeError("Client is closed. Can't send update-graph message.")

    dask = pytest.importorskip("flexsc.dask")
    with pytest.raises(OSError, match="the connection to the scheduler is lost"):
        dask.campaign(Closed(), sampled, 10)

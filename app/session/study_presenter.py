"""A study of one session: it is computed when its button is pressed, shown beside the maps, and stored for files."""

from __future__ import annotations

from typing import Any, NamedTuple

from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from app.views.analysis.study_view import StudyView
from engine.jobs.job import Job
from plots.studies.study import Click, Study, Subject


class _Run(NamedTuple):
    """What is computed: the subject, and the axis of the charts."""

    subject: Subject
    axis: str


class StudyPresenter:
    """Computes a study, shows it, and changes the view at a click on its charts.

    Parameters
    ----------
    study
        The study.
    context
        The session.
    """

    def __init__(self, study: Study[Any], context: SessionContext) -> None:
        self._study, self._state, self._results = study, context.state, context.results
        self._change = context.change
        self._run: _Run | None = None
        self._call: Job[Any] | None = None
        # The run whose result is shown. It differs from `_run` until the first result of a new run arrives.
        self._shown_run: _Run | None = None
        self.view = StudyView(study, self._state, self._toggle, self.click, context.latest)
        self._request = LatestRequest(context.jobs, self._show, self._fail, context.latest)
        if study.follows_map:
            self._state.follow(lambda analysis: self._follow_map(), "analysis")
            self._results.param.watch(lambda event: self._follow_map(), "frame")
        self._state.param.watch(lambda *events: self._stop(), ["system", "plane", "section", "t_max"])
        self._state.param.watch(lambda *events: self._show(None), "system")

    def _toggle(self) -> None:
        """Start the study, or stop it if it is running."""
        if self.view.running:
            self._stop()
            return
        self._start(_Run(self._state.subject, self.view.axis))

    def _follow_map(self) -> None:
        """Start the study of a map, complete or not, unless it is known, while its tab is open."""
        frame = self._results.frame
        if self._state.analysis != self._study.name or frame is None or frame.spec.potential != self._state.potential:
            return
        run = _Run(self._state.subject, self.view.axis)
        is_stopped = frame.complete and not (self.view.running or self._is_known(run))
        if run != self._run or is_stopped:
            self._start(run)

    def _is_known(self, run: _Run) -> bool:
        """Whether the complete result of a run is shown."""
        found = self.view.shown
        return run == self._shown_run and found is not None and self._study.is_complete(found)

    def _start(self, run: _Run) -> None:
        try:
            job = self._study.job(*run)
        except ValueError as error:
            self._stop()
            self.view.say(str(error))
            return
        self._run, self._call = run, self._study.call(job)
        self.view.show_running(True)
        self._request.submit(job)

    def _stop(self) -> None:
        self._request.cancel()
        self.view.show_running(False)

    def _fail(self, sentence: str) -> None:
        self.view.show_running(False)
        self.view.say(sentence)

    def _show(self, found: Any) -> None:
        """Show and store a result, complete or not; None removes it."""
        if found is not None and self._study.is_complete(found):
            self._stop()
        self._shown_run = self._run
        self.view.show(found, "" if self._run is None or found is None else self._run.axis)
        self._store("studies", found)
        self._store("calls", None if found is None else self._call)

    def _store(self, kind: str, value: Any) -> None:
        """Store the result, or its call, under the name of the study; None removes it."""
        others = {name: known for name, known in getattr(self._results, kind).items() if name != self._study.name}
        setattr(self._results, kind, others if value is None else {**others, self._study.name: value})

    def click(self, click: Click) -> None:
        """Change the view as the study says for a click on a chart."""
        if self.view.shown is None or self._shown_run is None:
            return
        self._change(self._study.changes(*self._shown_run, self.view.shown, click))

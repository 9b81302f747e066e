"""Notices are text, and the same notice can be shown twice."""

from __future__ import annotations

import panel as pn
from bokeh.document import Document

from app.views.components.notice import MODEL_NAME, Notice, show_lasting_notice


def test_the_same_notice_twice_is_two_changes() -> None:
    notice = Notice()
    contents = []
    notice.layout().param.watch(lambda event: contents.append(event.new), "object")
    notice.show("Link copied.")
    notice.show("Link copied.")
    assert len(contents) == 2
    assert all("Link copied." in content for content in contents)


def test_a_warning_is_text_in_an_alert_until_it_is_cleared() -> None:
    notice = Notice()
    notice.warn("<b>x</b>")
    assert "role='alert'" in notice.layout().object
    assert "&lt;b&gt;x&lt;/b&gt;" in notice.layout().object
    notice.clear()
    assert notice.layout().object == ""


def test_a_picture_stays_until_it_is_closed_or_cleared() -> None:
    notice = Notice()
    notice.show_picture("Exit <1>", "<svg></svg>")
    html = notice.layout().object
    assert "passing" not in html
    assert "<svg></svg><p role='status'>Exit &lt;1&gt;</p><form method='dialog'>" in html
    notice.clear()
    assert notice.layout().object == ""


def test_the_server_finds_the_notice_in_a_document() -> None:
    document = Document()
    # Without a notice the document stays unchanged.
    show_lasting_notice(document, "restart")
    pn.Column(Notice().layout()).server_doc(document)
    show_lasting_notice(document, "<i>restart</i>")
    assert "restart" in document.get_model_by_name(MODEL_NAME).text
    assert "<i>" not in document.get_model_by_name(MODEL_NAME).text

"""What the server says twice in a moment stays as it said it last."""

from __future__ import annotations

from tests.browser.explorer_page import ExplorerPage

_MODEL = "[...Bokeh.documents[0]._all_models.values()].find(model => model.data?.label === label).data"
# As messages of the server would, the second one when the widget has been drawn and has not answered yet.
_SAY_TWICE = f"""async (button, label) => {{
    const data = {_MODEL}
    const say = value => Bokeh.documents[0].apply_json_patch(
        {{events: [{{kind: "ModelChanged", model: {{id: data.id}}, attr: "disabled", new: value}}]}})
    await new Promise(resolve => {{
        const drawn = new MutationObserver(() => {{ drawn.disconnect(); say(true); resolve() }})
        drawn.observe(button, {{attributes: true, attributeFilter: ["disabled"]}})
        say(false)
    }})
    await new Promise(resolve => setTimeout(resolve, 300))
    return [data.disabled, button.disabled]
}}"""
_SWITCH_ON = f"""label => Bokeh.documents[0].apply_json_patch(
    {{events: [{{kind: "ModelChanged", model: {{id: {_MODEL}.id}}, attr: "value", new: true}}]}})"""


def test_no_widget_takes_back_what_the_server_has_told_it(shared: ExplorerPage) -> None:
    button = shared.page.get_by_role("button", name="Next frame")
    assert button.is_disabled()
    assert button.evaluate(_SAY_TWICE, "Time along the orbits") == [True, True]


def test_a_visitor_can_take_back_at_once_what_the_server_has_switched_on(shared: ExplorerPage) -> None:
    label = "Pixels to trust"
    shared.page.evaluate(_SWITCH_ON, label)
    shared.page.get_by_label(label, exact=True).click()
    shared.page.wait_for_function(f"label => {_MODEL}.value === false", arg=label)

"""A viewer without a screen, and a browser. They are imported when a test asks for them."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.viewer.chromium import Browser
    from tests.viewer.driver import Driver


@pytest.fixture
def driver() -> "Iterator[Driver]":
    from tests.viewer.driver import viewer

    with viewer() as driver:
        yield driver


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> "Iterator[Browser]":
    from tests.viewer.chromium import chromium

    with chromium(tmp_path_factory.mktemp("profile")) as tab:
        yield tab


@pytest.fixture
def desktop(browser: "Browser", page: Path) -> "Browser":
    """The module's page in a browser as large as a projector's window."""
    browser.size(1280, 720)
    browser.open(page.as_uri())
    return browser

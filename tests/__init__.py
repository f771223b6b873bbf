"""Tests. The folders mirror the rooms of the program."""

from pathlib import Path

ROOT = Path(__file__).parent.parent

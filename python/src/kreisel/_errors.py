"""Exceptions of kreisel, of the same kinds as those of the C++ library."""


class Error(Exception):
    """Base class of the exceptions of this package."""


class InvalidInput(Error, ValueError):
    """Invalid data; the message names the value and the reason."""


class SceneNotFound(InvalidInput, FileNotFoundError):
    """A scene file that does not exist."""


class SceneMistakes(InvalidInput):
    """Mistakes in a scene, a line for each: place: key: reason."""

    @property
    def mistakes(self):
        """The mistakes, a text for each."""
        return str(self).split("\n")


class ComputationFailed(Error):
    """Valid data without a computable answer."""


class ToleranceMissed(RuntimeWarning):
    """The warning after a computation that did not reach its tolerance (exit status 4)."""

"""Certificates: files that say what is proved of a loop, and that are believed only after they are proved anew."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from . import _core
from .answers import CertificateCheck

if TYPE_CHECKING:
    from os import PathLike

    from .scenario import Scenario


class Certificate:
    """A certificate as ``certify`` writes it: nothing in it is trusted but its numbers.

    Made by :meth:`from_file` or :meth:`from_text`; :meth:`Scenario.certify` has the texts in ``certificates``.
    """

    def __init__(self, text: str, path: Path | None = None) -> None:
        self._text, self._path = text, path

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Certificate:
        """Read the file of a certificate.

        Raises
        ------
        FileError
            It cannot be read.
        """
        return cls(_core.read_certificate(Path(path)), Path(path))

    @classmethod
    def from_text(cls, text: str) -> Certificate:
        """Take the text of a certificate, such as one of ``Certification.certificates``."""
        return cls(text)

    @property
    def text(self) -> str:
        """Its text: JSON."""
        return self._text

    def check(self, against: Scenario | None = None) -> CertificateCheck:
        """Prove it anew from its description alone, in interval arithmetic.

        Parameters
        ----------
        against : Scenario, optional
            Compare it as well with what this scenario flies, field by field.

        Returns
        -------
        CertificateCheck
            True in a condition where it proves the flown loop stable, and is what the scenario flies, if one is given.

        Raises
        ------
        InputError
            The text is no certificate, with everything that is wrong with it.
        """
        name = "certificate" if self._path is None else str(self._path)
        return CertificateCheck(
            _core.check_certificate(self._text, name, self._path, None if against is None else against._core)
        )

    def __repr__(self) -> str:
        return "Certificate()" if self._path is None else f"Certificate({str(self._path)!r})"

"""Whether a bill of materials is what CycloneDX 1.6 says, by the schema of the standard: valid.py FILE."""

import pathlib
import sys

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

wrong = JsonStrictValidator(SchemaVersion.V1_6).validate_str(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
if wrong is not None:
    sys.exit(f"{sys.argv[1]}: {wrong}")
print(f"{sys.argv[1]}: valid CycloneDX 1.6")

"""The digest by which `project` and `export` know a registration as `incise register` wrote it."""

import hashlib
import json


def sealed(document):
    """With the SHA-256 of its compact JSON without that key, as the last one."""
    rest = {key: value for key, value in document.items() if key != "digest_sha256"}
    return {**rest, "digest_sha256": hashlib.sha256(json.dumps(rest, separators=(",", ":"), ensure_ascii=False).encode()).hexdigest()}

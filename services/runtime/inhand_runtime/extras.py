"""The optional dependencies of the distribution, and the line about one that is not installed."""

EXTRAS = {
    "cluster": ("dask", "distributed"),
    "export": ("av", "foxglove", "pyarrow", "rosbags"),
    "h264": ("av",),
    "homeassistant": ("aiomqtt",),
    "hub": ("cryptography",),
    "lab": ("faiss", "fast_simplification", "matplotlib", "scipy", "sklearn", "trimesh"),
    "metrics": ("prometheus_client",),
    "outcomes": ("alembic", "sqlalchemy"),
    "pose": ("ai_edge_litert",),
    "oak": ("depthai",),
    "onnx": ("onnxruntime",),
    "postgresql": ("psycopg",),
    "studio": ("aiohttp", "viser"),
}
"""Names of the modules that come with each extra of ours (pyproject.toml) and not without it."""


def missing_extra(error: ModuleNotFoundError) -> str | None:
    """Say which extra has what could not be imported; None where none has."""
    module = (error.name or "").partition(".")[0]
    for extra, modules in EXTRAS.items():
        if module in modules:
            return f'needs the extra {extra!r}: pip install "inhand[{extra}]"'
    return None

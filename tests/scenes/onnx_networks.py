"""Networks of ONNX that say the same of every picture."""

from pathlib import Path

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

SIDE = 64


def write_network(path: Path, said: NDArray[np.float32], *, side: int = SIDE) -> Path:
    """Write a network that takes a picture (1, 3, side, side) and always gives ``said``."""
    shape = [1, 3, side, side]
    taken = helper.make_tensor_value_info("images", TensorProto.FLOAT, shape)
    given = helper.make_tensor_value_info("output0", TensorProto.FLOAT, said.shape)
    nodes = [
        helper.make_node("ReduceMean", ["images"], ["mean"], keepdims=0),
        helper.make_node("Mul", ["mean", "nothing"], ["none"]),
        helper.make_node("Add", ["said", "none"], ["output0"]),
    ]
    constants = [
        numpy_helper.from_array(np.float32(0.0), "nothing"),
        numpy_helper.from_array(said, "said"),
    ]
    graph = helper.make_graph(nodes, "told", [taken], [given], constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.save(model, path)
    return path

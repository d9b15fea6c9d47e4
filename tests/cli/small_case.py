"""A small specimen for tests of the command: a block of tetrahedra, a tumour edge on top of it, and their case file."""

import math
import pathlib
from itertools import permutations

# x: left-right, y: front (low) to back, z: height; mm, LPS.
BLOCK_MM = (40.0, 60.0, 14.0)
CELLS = (12, 18, 4)
TUMOR_CENTER_MM = (20.0, 20.0)  # where it lies once the block is stretched
TUMOR_RADIUS_MM = 5.0

# Long steps and little drag: the cut is coarse, but every stage is the real one.
CASE = {
    "schema": "incise.case/1",
    "title": "Test block",
    "specimen_is": "virtual",
    "specimen": {
        "mesh": "block.msh",
        "material": {"poissons_ratio": 0.45},
    },
    "tumor": {"contour": "tumor.csv"},
    "plan": {"lateral_margin_mm": 5, "depth_mm": 5, "waypoints": 24},
    "cut": {"dullness": 5, "advance_per_step_mm": 0.8, "frames": 2},
    "robot": {"T_robot_sim": [[0, 1, 0, 500], [-1, 0, 0, 20], [0, 0, 1, 200], [0, 0, 0, 1]]},
}


# With these a program is written although the mesh is far too coarse for the paper's margins: the tests need one, no robot ever does.
SOUND = {"plan": {"lateral_margin_mm": 9, "close_margin_mm": 0.2}, "tumor": {"surface": "tumor.stl"}}
ACCEPTED = tuple(word for caution in ("not_corrected", "mesh_resolution", "convergence") for word in ("--accept", caution))


def block(size_mm=BLOCK_MM, cells=CELLS):
    """Vertices and tets of a block, each cell cut into six tets whose faces match (Kuhn)."""
    nx, ny, nz = cells
    vertices = [
        (size_mm[0] * i / nx, size_mm[1] * j / ny, size_mm[2] * k / nz)
        for k in range(nz + 1)
        for j in range(ny + 1)
        for i in range(nx + 1)
    ]

    def number(i, j, k):
        return i + (nx + 1) * (j + (ny + 1) * k)

    tets = []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                for order in permutations(range(3)):
                    corner = [i, j, k]
                    path = [number(*corner)]
                    for axis in order:
                        corner[axis] += 1
                        path.append(number(*corner))
                    is_odd = order in ((0, 2, 1), (1, 0, 2), (2, 1, 0))
                    if is_odd:
                        path[2], path[3] = path[3], path[2]
                    tets.append(tuple(path))
    return vertices, tets


def write_msh(path, vertices, tets):
    """Gmsh 2.2, ascii."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(vertices))]
    lines += [f"{n + 1} {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(vertices)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += [f"{n + 1} 4 2 1 1 " + " ".join(str(corner + 1) for corner in tet) for n, tet in enumerate(tets)]
    lines += ["$EndElements", ""]
    pathlib.Path(path).write_text("\n".join(lines))


def write_contour(path, points):
    lines = ["x_mm,y_mm,z_mm"] + [f"{x!r},{y!r},{z!r}" for x, y, z in points]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def ring(center=TUMOR_CENTER_MM, radius=TUMOR_RADIUS_MM, z=BLOCK_MM[2], corners=60):
    angles = [2.0 * math.pi * n / corners for n in range(corners)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a), z) for a in angles]


def path(points, frame="robot", waypoint=None, **more):
    """The JSON of a closed tool path. @param waypoint: keys laid over those of every waypoint. @param more: keys laid over those of the path."""
    waypoints = [{"position_mm": p, "axis": [0, 0, -1], "depth_mm": 5, "speed_mm_s": 7, **(waypoint or {})} for p in points]
    return {"frame": frame, "kind": "incise", "closed": True, "waypoints": waypoints, **more}


TUMOR_DEPTH_MM = 3.0


def write_tumor_surface(path, corners=24, scale=1.0):
    """STL, ascii: the upright cylinder below the tumour's edge, with outward triangles."""
    top = [(scale * x, scale * y, scale * z) for x, y, z in ring(corners=corners)]
    bottom = [(x, y, z - scale * TUMOR_DEPTH_MM) for x, y, z in top]
    triangles = []
    for n in range(corners):
        m = (n + 1) % corners
        triangles += [(top[0], top[n], top[m]), (bottom[0], bottom[m], bottom[n])] if n not in (0, corners - 1) else []
        triangles += [(bottom[n], bottom[m], top[m]), (bottom[n], top[m], top[n])]
    lines = ["solid tumor"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"] + [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle] + ["endloop", "endfacet"]
    pathlib.Path(path).write_text("\n".join(lines + ["endsolid tumor", ""]))


def merged(base, changes):
    """`base` with `changes` laid over it, group by group; None takes a key away."""
    result = dict(base)
    for key, value in changes.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        else:
            result[key] = value
    return result


def write_case(folder, changes=None):
    """A case folder that runs as it is; `changes` are laid over CASE. Returns the folder."""
    import json

    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_msh(folder / "block.msh", *block())
    write_contour(folder / "tumor.csv", ring())
    (folder / "case.yaml").write_text(json.dumps(merged(CASE, changes or {}), indent=1))  # JSON is YAML
    return folder

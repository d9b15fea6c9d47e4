"""Writes the files of this folder with VTK's own writers (VTK 9.1), so that our readers are tested against another program.

Two tetrahedra and one triangle, with point and cell data. Run it in this folder: python3 make_vtk_files.py
"""
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

grid = vtkUnstructuredGrid()
points = vtkPoints()
points.SetDataTypeToDouble()
for p in [(0.1, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1.0 / 3.0)]:
    points.InsertNextPoint(p)
grid.SetPoints(points)
grid.InsertNextCell(10, 4, [0, 1, 2, 3])
grid.InsertNextCell(5, 3, [0, 1, 2])
grid.InsertNextCell(10, 4, [1, 2, 3, 4])
displacement = vtkDoubleArray()
displacement.SetName("displacement_mm")
displacement.SetNumberOfComponents(3)
for i in range(5):
    displacement.InsertNextTuple3(0.1 * i, -1.0, i)
grid.GetPointData().AddArray(displacement)
region = vtkIntArray()
region.SetName("region")
for value in (7, 8, 9):
    region.InsertNextValue(value)
grid.GetCellData().AddArray(region)


def write_xml(name, mode, compressed, encoded=False, big_endian=False, header=32):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(name)
    writer.SetInputData(grid)
    writer.SetDataMode({"ascii": 0, "binary": 1, "appended": 2}[mode])
    writer.SetEncodeAppendedData(encoded)
    if compressed:
        writer.SetCompressorTypeToZLib()
    else:
        writer.SetCompressorTypeToNone()
    writer.SetByteOrder(0 if big_endian else 1)
    writer.SetHeaderType(header)
    writer.Write()


write_xml("ascii.vtu", "ascii", False)
write_xml("binary.vtu", "binary", False)
write_xml("binary_zlib.vtu", "binary", True, header=64)
write_xml("appended_raw.vtu", "appended", False, header=64)
write_xml("appended_raw_zlib.vtu", "appended", True)
write_xml("appended_base64.vtu", "appended", False, encoded=True)
write_xml("appended_base64_zlib.vtu", "appended", True, encoded=True, header=64)
write_xml("big_endian.vtu", "appended", True, big_endian=True)

for name, version, binary in [("ascii_42.vtk", 42, False), ("binary_42.vtk", 42, True), ("ascii_51.vtk", 51, False),
                              ("binary_51.vtk", 51, True)]:
    writer = vtkUnstructuredGridWriter()
    writer.SetFileName(name)
    writer.SetInputData(grid)
    writer.SetFileVersion(version)
    writer.SetFileType(2 if binary else 1)
    writer.Write()

"""Makes solids that everybody knows with Blender, as OBJ files in a folder, and closed copies of those that
are open: blender -b --python public_solids.py -- FOLDER
"""
import pathlib
import sys

import addon_utils
import bpy

folder = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
addon_utils.enable("add_mesh_extra_objects")


def write(name):
    bpy.ops.wm.obj_export(filepath=str(folder / f"{name}.obj"), export_selected_objects=True,
                          export_materials=False, export_normals=False, export_uv=False)


def make(name, add):
    """The solid about 1 m across; and a copy with its holes filled, whose skin in small voxels is closed."""
    bpy.ops.object.select_all(action="DESELECT")
    add()
    solid = bpy.context.object
    solid.scale = [1 / max(solid.dimensions)] * 3
    bpy.ops.object.transform_apply(scale=True, location=True, rotation=True)
    write(name)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.remove_doubles(threshold=1e-4)
    bpy.ops.mesh.fill_holes(sides=0)
    bpy.ops.object.mode_set(mode="OBJECT")
    solid.data.remesh_voxel_size = 0.005
    bpy.ops.object.voxel_remesh()
    write(name + "_closed")


make("suzanne", bpy.ops.mesh.primitive_monkey_add)
make("teapot", lambda: bpy.ops.mesh.primitive_teapot_add(resolution=8, objecttype="1"))
make("torus", bpy.ops.mesh.primitive_torus_add)
make("icosphere", lambda: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4))

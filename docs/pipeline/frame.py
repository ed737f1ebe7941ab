"""Draws one frame of an exported surface with Blender, without a display.

    neve export scenes/snowball_drop.toml --format ply --surface --up z --frames 7-7 --out mesh
    blender -b --python docs/pipeline/frame.py -- mesh/ply/0007.ply frame.png [SAMPLES]

The snow is white with some light under its surface, the spray small balls, the ground dark.
"""

import math
import sys

import bpy
from mathutils import Vector

ply, picture, *rest = sys.argv[sys.argv.index("--") + 1:]
samples = int(rest[0]) if rest else 40

# 1. Nothing but the mesh.
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="io_mesh_ply")
bpy.ops.import_mesh.ply(filepath=ply)
snow = bpy.context.object
for polygon in snow.data.polygons:
    polygon.use_smooth = True


def material(name, color, subsurface=0.0, roughness=0.8):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"].inputs
    shader["Base Color"].default_value = (*color, 1)
    shader["Roughness"].default_value = roughness
    shader["Subsurface"].default_value = subsurface
    shader["Subsurface Radius"].default_value = (0.01, 0.012, 0.015)
    shader["Subsurface Color"].default_value = (*color, 1)
    return made


white = material("snow", (0.9, 0.93, 0.97), subsurface=0.3)
snow.data.materials.append(white)

# 2. Vertices in no face are spray: a ball at each.
in_faces = {v for polygon in snow.data.polygons for v in polygon.vertices}
loose = [v.co.copy() for v in snow.data.vertices if v.index not in in_faces]
points = bpy.data.meshes.new("spray")
points.from_pydata(loose, [], [])
spray = bpy.data.objects.new("spray", points)
spray.instance_type = "VERTS"
bpy.context.collection.objects.link(spray)
bpy.ops.mesh.primitive_ico_sphere_add(radius=0.0025, subdivisions=2)
ball = bpy.context.object
ball.data.materials.append(white)
ball.parent = spray

# 3. Ground, sun, sky.
bpy.ops.mesh.primitive_plane_add(size=200)
bpy.context.object.data.materials.append(material("ground", (0.045, 0.05, 0.06)))
bpy.ops.object.light_add(type="SUN", rotation=(math.radians(50), math.radians(10), math.radians(-40)))
bpy.context.object.data.energy = 2.4
bpy.context.object.data.angle = math.radians(2)
world = bpy.data.worlds.new("sky")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.35, 0.48, 0.7, 1)
world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.4
bpy.context.scene.world = world

# 4. A camera that sees all of the mesh.
corners = [Vector(v.co) for v in snow.data.vertices if v.index in in_faces]
low = Vector([min(c[a] for c in corners) for a in range(3)])
high = Vector([max(c[a] for c in corners) for a in range(3)])
middle, size = (low + high) / 2, (high - low).length
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location = middle + 1.25 * size * Vector((0.35, -1, 0.3))
camera.rotation_euler = (middle - camera.location).to_track_quat("-Z", "Y").to_euler()
bpy.context.collection.objects.link(camera)

scene = bpy.context.scene
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples = samples
scene.cycles.use_denoising = False
scene.render.resolution_x, scene.render.resolution_y = 960, 540
scene.view_settings.view_transform = "Standard"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
print(f"neve: {len(snow.data.polygons)} triangles, {len(loose)} grains of spray")

"""Blender add-on: reads exports of a Vantage take as a scene.

It reads, from the files and folders that `vantage take export` writes:

* `camera.csv` (--as camera): the flight, as an animated camera;
* a moment of --as training: a camera per rig with its picture as background, and the points;
* `.glb` files (--as glb): the surfaces of moments, a frame each;
* `.ply` files (--as ply): coloured points of moments, a frame each.

Install it in Preferences, Add-ons, Install; then use File, Import, Vantage export. Without a window:

    blender --background --python vantage_import.py -- EXPORT... -o scene.blend
"""

import csv
import json
import sys
from pathlib import Path

import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

bl_info = {
    "name": "Vantage export",
    "author": "The Vantage contributors",
    "version": (0, 3, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Vantage export",
    "description": "Reads flights, rigs, surfaces and points of a Vantage take",
    "category": "Import-Export",
}

# Vantage's world has y up, and Blender's z up.
BLENDER_FROM_WORLD = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
# Vantage's cameras have y down and look along z, and Blender's y up and along -z.
CAMERA_AXES = Matrix(((1, 0, 0, 0), (0, -1, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1)))
SENSOR_MM = 36.0


class ExportError(Exception):
    """A file is not what it has to be; the message is a sentence."""


def collection_of(name):
    """A collection of the scene with this name, made if there is none."""
    collection = bpy.data.collections.get(name)
    if collection is None:
        collection = bpy.data.collections.new(name)
        bpy.context.scene.collection.children.link(collection)
    return collection


def new_camera(name, collection):
    data = bpy.data.cameras.new(name)
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_MM
    camera = bpy.data.objects.new(name, data)
    camera.rotation_mode = "QUATERNION"
    collection.objects.link(camera)
    return camera


def show_only_at(thing, frame, last):
    """Shows an object at one frame of several."""
    if last == 0:
        return
    for at, hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
        thing.hide_viewport = thing.hide_render = hidden
        thing.keyframe_insert("hide_viewport", frame=at)
        thing.keyframe_insert("hide_render", frame=at)


def read_flight(path):
    """The flight of camera.csv as an animated camera. Returns the camera."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    columns = {"time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "field_of_view_deg", "focus_m"}
    if not rows or not columns <= set(rows[0]):
        raise ExportError(f"{path} is no flight: vantage take export --as camera writes camera.csv")
    scene = bpy.context.scene
    rate = (len(rows) - 1) / float(rows[-1]["time_s"]) if len(rows) > 1 else 25.0
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate
    camera = new_camera("Flight", collection_of("Vantage flight"))
    camera.data.dof.use_dof = False
    before = None
    for frame, row in enumerate(rows, start=1):
        number = {name: float(row[name]) for name in columns}
        pose = Quaternion((number["qw"], number["qx"], number["qy"], number["qz"])).to_matrix().to_4x4()
        pose.translation = Vector((number["x_m"], number["y_m"], number["z_m"]))
        place, turn, _ = (BLENDER_FROM_WORLD @ pose @ CAMERA_AXES).decompose()
        if before is not None and before.dot(turn) < 0:
            turn.negate()
        before = turn.copy()
        camera.location, camera.rotation_quaternion = place, turn
        camera.data.angle_x = number["field_of_view_deg"] * 3.141592653589793 / 180
        camera.data.dof.focus_distance = number["focus_m"]
        camera.keyframe_insert("location", frame=frame)
        camera.keyframe_insert("rotation_quaternion", frame=frame)
        camera.data.keyframe_insert("lens", frame=frame)
        camera.data.dof.keyframe_insert("focus_distance", frame=frame)
    scene.frame_start, scene.frame_end = 1, len(rows)
    scene.camera = camera
    return camera


def read_ply(path):
    """Positions (n, 3) and colours (n, 3) of uint8 of a binary PLY that Vantage wrote."""
    formats = {"float": "<f4", "uchar": "u1", "int": "<i4", "uint": "<u4"}
    with open(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            line = file.readline().decode("ascii", "replace").strip()
            header.append(line)
            if len(header) > 50 or not line:
                raise ExportError(f"{path} is no PLY")
        if header[0] != "ply" or "format binary_little_endian 1.0" not in header:
            raise ExportError(f"{path} is no binary PLY")
        count, layout, element = 0, [], ""
        for words in (line.split() for line in header):
            if words[0] == "element":
                element = words[1]
                count = int(words[2]) if element == "vertex" else count
            elif words[0] == "property" and element == "vertex":
                layout.append((words[2], formats[words[1]]))
        size = numpy.dtype(layout).itemsize
        data = file.read(count * size)
        if len(data) < count * size:
            raise ExportError(f"{path} is cut short")
    points = numpy.frombuffer(data, layout, count)
    return (
        numpy.stack([points[axis] for axis in "xyz"], axis=1),
        numpy.stack([points[channel] for channel in ("red", "green", "blue")], axis=1),
    )


def linear_colours(coded):
    """(n, 4) R, G, B, A in Blender's linear light of (n, 3) colours of sRGB in 8 bits."""
    steps = numpy.arange(256) / 255
    decoded = numpy.where(steps <= 0.04045, steps / 12.92, ((steps + 0.055) / 1.055) ** 2.4)
    colours = numpy.ones((len(coded), 4), numpy.float32)
    colours[:, :3] = decoded[coded]
    return colours


def point_material():
    """A material that shows the colours of points."""
    material = bpy.data.materials.get("Vantage points")
    if material is None:
        material = bpy.data.materials.new("Vantage points")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        colour, light, out = (
            nodes.new(kind)
            for kind in ("ShaderNodeAttribute", "ShaderNodeEmission", "ShaderNodeOutputMaterial")
        )
        colour.attribute_name = "Col"
        links.new(colour.outputs["Color"], light.inputs["Color"])
        links.new(light.outputs["Emission"], out.inputs["Surface"])
    return material


def add_points(name, path, collection, radius_m=0.01):
    """The points of a PLY as an object of vertices, drawn as spheres. Returns the object."""
    positions, colours = read_ply(path)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(positions))
    placed = positions @ numpy.array(BLENDER_FROM_WORLD.to_3x3()).T
    mesh.vertices.foreach_set("co", placed.astype(numpy.float32).ravel())
    attribute = mesh.attributes.new("Col", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", linear_colours(colours).ravel())
    mesh.update()
    mesh.materials.append(point_material())
    thing = bpy.data.objects.new(name, mesh)
    collection.objects.link(thing)
    thing["points"] = len(positions)
    group = bpy.data.node_groups.get("Vantage points") or point_nodes(radius_m)
    thing.modifiers.new("Points", "NODES").node_group = group
    return thing


def point_nodes(radius_m):
    """Geometry nodes that turn vertices into points with a radius."""
    group = bpy.data.node_groups.new("Vantage points", "GeometryNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        group.inputs.new("NodeSocketGeometry", "Geometry")
        group.outputs.new("NodeSocketGeometry", "Geometry")
    source, points, material, out = (
        group.nodes.new(kind)
        for kind in (
            "NodeGroupInput",
            "GeometryNodeMeshToPoints",
            "GeometryNodeSetMaterial",
            "NodeGroupOutput",
        )
    )
    points.inputs["Radius"].default_value = radius_m
    material.inputs["Material"].default_value = point_material()
    group.links.new(source.outputs[0], points.inputs["Mesh"])
    group.links.new(points.outputs["Points"], material.inputs["Geometry"])
    group.links.new(material.outputs["Geometry"], out.inputs[0])
    return group


def read_training(folder):
    """The rigs of a moment as cameras with their pictures, and its points. Returns the cameras."""
    document = json.loads((folder / "transforms.json").read_text(encoding="utf-8"))
    if "frames" not in document:
        raise ExportError(f"{folder / 'transforms.json'} has no frames")
    collection = collection_of("Vantage rigs")
    cameras = []
    for frame in document["frames"]:
        camera = new_camera(Path(frame["file_path"]).stem, collection)
        # transforms.json has Blender's camera axes already.
        camera.matrix_world = BLENDER_FROM_WORLD @ Matrix(frame["transform_matrix"])
        width, height = frame["w"], frame["h"]
        data = camera.data
        data.lens = frame["fl_x"] * SENSOR_MM / width
        data.shift_x = (width / 2 - frame["cx"]) / width
        data.shift_y = (frame["cy"] - height / 2) / width
        data.show_background_images = True
        background = data.background_images.new()
        background.image = bpy.data.images.load(str(folder / frame["file_path"]), check_existing=True)
        cameras.append(camera)
    if cameras:
        scene = bpy.context.scene
        scene.camera = scene.camera or cameras[0]
    if document.get("ply_file_path"):
        add_points(
            f"Points {folder.name}", folder / document["ply_file_path"], collection_of("Vantage points")
        )
    return cameras


def read_surfaces(files):
    """The surfaces of moments, a frame each. Returns the objects."""
    # The glTF reader of Blender 3.4 uses a name that NumPy 1.24 no longer has; Debian 12 has both.
    if not hasattr(numpy, "bool"):
        numpy.bool = bool
    things = []
    for frame, path in enumerate(files, start=1):
        before = set(bpy.data.objects)
        bpy.ops.import_scene.gltf(filepath=str(path))
        for thing in set(bpy.data.objects) - before:
            thing.name = f"Surface {path.stem}"
            show_only_at(thing, frame, len(files) - 1)
            things.append(thing)
    return things


def read_points(files):
    """The points of moments, a frame each. Returns the objects."""
    collection = collection_of("Vantage points")
    things = []
    for frame, path in enumerate(files, start=1):
        things.append(add_points(f"Points {path.stem}", path, collection))
        show_only_at(things[-1], frame, len(files) - 1)
    return things


def read_export(path):
    """Reads a file or folder of any export of these. Returns a sentence about what came in."""
    path = Path(path)
    if path.name == "camera.csv" or (path / "camera.csv").is_file():
        file = path if path.is_file() else path / "camera.csv"
        read_flight(file)
        return f"{file}: a flight of {bpy.context.scene.frame_end} frames"
    if path.name == "transforms.json":
        path = path.parent
    if (path / "transforms.json").is_file():
        return f"{path}: {len(read_training(path))} rigs"
    moments = sorted(path.glob("*/transforms.json")) if path.is_dir() else []
    if moments:
        return f"{moments[0].parent}: {len(read_training(moments[0].parent))} rigs"
    for suffix, read in ((".glb", read_surfaces), (".ply", read_points)):
        files = [path] if path.suffix == suffix else sorted(path.glob("*" + suffix)) if path.is_dir() else []
        if files:
            return f"{path}: {len(read(files))} objects of {len(files)} moments"
    raise ExportError(
        f"{path} is no export that this add-on reads: it reads --as camera, training, glb and ply"
    )


class IMPORT_SCENE_OT_vantage(bpy.types.Operator):
    """Read flights, rigs, surfaces and points of a Vantage take"""

    bl_idname = "import_scene.vantage"
    bl_label = "Import Vantage export"
    bl_options = {"REGISTER", "UNDO"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")

    def execute(self, context):
        try:
            self.report({"INFO"}, read_export(self.filepath))
        except (ExportError, OSError, RuntimeError, ValueError, KeyError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


def add_to_menu(self, context):
    self.layout.operator(IMPORT_SCENE_OT_vantage.bl_idname, text="Vantage export")


def register():
    bpy.utils.register_class(IMPORT_SCENE_OT_vantage)
    bpy.types.TOPBAR_MT_file_import.append(add_to_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(add_to_menu)
    bpy.utils.unregister_class(IMPORT_SCENE_OT_vantage)


def main(arguments):
    """Reads exports into an empty scene, and saves it with -o FILE.blend."""
    output = ""
    if "-o" in arguments:
        at = arguments.index("-o")
        output = arguments[at + 1]
        del arguments[at : at + 2]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Other view transforms change the colours that were filmed.
    bpy.context.scene.view_settings.view_transform = "Standard"
    try:
        for export in arguments:
            print(read_export(export))
    except (ExportError, OSError, RuntimeError, ValueError, KeyError) as error:
        sys.exit(f"error: {error}")
    if output:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(output).resolve()))


if __name__ == "__main__":
    if bpy.app.background and "--" in sys.argv:
        main(sys.argv[sys.argv.index("--") + 1 :])
    else:
        register()

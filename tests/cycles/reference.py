# Pictures of coif's strands by another path tracer: Cycles, in Blender 3.4 (Debian 12: apt-get install
# --no-install-recommends blender), of the scenes that scenes.txt lists. From the repository's root:
#
#     blender -b --factory-startup -P tests/cycles/reference.py -- build/coif 192
#
# with the program and the samples a pixel; a quarter of an hour on two cores. Each becomes NAME.hdr beside this script: light
# before any display transform, with nothing behind the head. They are of the strands as coif draws them: where those
# change, so must these.
import array, math, os, struct, subprocess, sys, tempfile, tomllib
import bpy
from mathutils import Matrix, Vector

WIDTH, HEIGHT = 160, 184
POINTS = 33  # of a strand
TILT = 2.0  # degrees, the default of look.scale_tilt, and in its sign: by the other one sparse black hair is a third darker
here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(os.path.dirname(here))
coif, samples = os.path.abspath(sys.argv[sys.argv.index('--') + 1]), int(sys.argv[sys.argv.index('--') + 2])
only = sys.argv[sys.argv.index('--') + 3:]  # names; none: all


def linear(srgb):  # IEC 61966-2-1
    return srgb / 12.92 if srgb <= 0.04045 else ((srgb + 0.055) / 1.055) ** 2.4


def color(text='#ffffff'):
    return [linear(int(text[i:i + 2], 16) / 255) for i in (1, 3, 5)]


def read_scenes():
    sets, scenes = [], []
    for line in open(os.path.join(here, 'scenes.txt')):
        words = line.split()
        if not words or words[0] == '#':
            continue
        if words[0] == 'set':
            sets.append(words[1])
        else:
            scenes.append(words)
    return sets, scenes


def read_strands(file):  # Cem Yuksel's .hair, as coif writes it: strands alike, with points, thickness and colours
    data = open(file, 'rb').read()
    strands, points, arrays, segments = struct.unpack_from('<4I', data, 4)
    assert data[:4] == b'HAIR' and arrays == 2 | 4 | 16 and points == strands * (segments + 1), file
    places = array.array('f', data[128:128 + 12 * points])
    widths = array.array('f', data[128 + 12 * points:128 + 16 * points])
    return strands, segments + 1, places, widths


def material(kind, **inputs):
    made = bpy.data.materials.new(kind)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(kind)
    if kind == 'ShaderNodeBsdfHairPrincipled':
        node.parametrization = 'ABSORPTION'
    for name, value in inputs.items():
        node.inputs[name.replace('_', ' ')].default_value = value
    out = tree.nodes.new('ShaderNodeOutputMaterial')
    tree.links.new(node.outputs[0], out.inputs[0])
    return made


def add_strands(file, absorption):
    strands, points, places, widths = read_strands(file)
    curve = bpy.data.curves.new('hair', 'CURVE')
    curve.dimensions = '3D'
    for s in range(strands):
        spline = curve.splines.new('POLY')
        spline.points.add(points - 1)
        at = array.array('f')
        for k in range(s * points, (s + 1) * points):
            at.extend((places[3 * k], places[3 * k + 1], places[3 * k + 2], 1.0))
        spline.points.foreach_set('co', at)
        spline.points.foreach_set('radius', array.array('f', [0.5 * w for w in widths[s * points:(s + 1) * points]]))
    hair = bpy.data.objects.new('hair', curve)
    bpy.context.scene.collection.objects.link(hair)
    bpy.context.view_layer.objects.active = hair
    hair.select_set(True)
    bpy.ops.object.convert(target='CURVES')
    # The defaults of look.roughness, look.azimuthal_roughness, look.ior and look.scale_tilt.
    bpy.context.object.data.materials.append(
        material('ShaderNodeBsdfHairPrincipled', Absorption_Coefficient=absorption, Roughness=0.3,
                 Radial_Roughness=0.3, Coat=0.0, IOR=1.55, Offset=math.radians(TILT), Random_Roughness=0.0))


def add_head():
    corners, faces = [], []
    for line in open(os.path.join(root, 'assets', 'head.obj')):
        words = line.split()
        if words[:1] == ['v']:
            corners.append([float(w) for w in words[1:4]])
        elif words[:1] == ['f']:
            faces.append([int(w.split('/')[0]) - 1 for w in words[1:]])
    mesh = bpy.data.meshes.new('head')
    mesh.from_pydata(corners, [], faces)
    mesh.polygons.foreach_set('use_smooth', [True] * len(faces))
    head = bpy.data.objects.new('head', mesh)
    bpy.context.scene.collection.objects.link(head)
    skin = [linear(c) for c in (0.80, 0.66, 0.58)]  # the default of head.color
    mesh.materials.append(material('ShaderNodeBsdfDiffuse', Color=(*skin, 1.0)))


def add_lights(name):
    with open(os.path.join(root, 'hairstyles', 'lights', name + '.toml'), 'rb') as file:
        lights = tomllib.load(file)
    for light in lights.get('light', []):
        sun = bpy.data.lights.new('sun', 'SUN')
        sun.energy = light['irradiance']
        sun.color = color(light.get('color', '#ffffff'))
        sun.angle = math.radians(2.0 * light.get('angle', 0.0))  # across
        made = bpy.data.objects.new('sun', sun)
        bpy.context.scene.collection.objects.link(made)
        made.rotation_mode = 'QUATERNION'
        made.rotation_quaternion = Vector(light['direction']).to_track_quat('Z', 'Y')
    world = bpy.data.worlds.new('sky')
    bpy.context.scene.world = world
    world.use_nodes = True
    sky = lights.get('sky', {})
    radiance = [sky.get('radiance', 0.0) * c for c in color(sky.get('color', '#ffffff'))]
    world.node_tree.nodes['Background'].inputs[0].default_value = (*radiance, 1.0)


def add_camera(of):
    yaw, pitch = math.radians(of['yaw']), math.radians(of['pitch'])
    target = Vector(of['target'])
    eye = target + of['distance'] * Vector(
        (math.cos(pitch) * math.sin(yaw), math.sin(pitch), math.cos(pitch) * math.cos(yaw)))
    forward = (target - eye).normalized()
    right = forward.cross(Vector((0, 1, 0))).normalized()
    camera = bpy.data.cameras.new('camera')
    camera.sensor_fit = 'VERTICAL'
    camera.angle = math.radians(of['fov'])
    camera.clip_start = 0.01
    made = bpy.data.objects.new('camera', camera)
    place = Matrix.Identity(4)
    for i, axis in enumerate((right, right.cross(forward), -forward, eye)):
        for k in range(3):
            place[k][i] = axis[k]
    made.matrix_world = place
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made


def render(file):
    scene = bpy.context.scene
    out = scene.render
    scene.render.engine = 'CYCLES'
    out.resolution_x, out.resolution_y, out.resolution_percentage = WIDTH, HEIGHT, 100
    out.film_transparent = True
    out.image_settings.file_format, out.image_settings.color_depth = 'OPEN_EXR', '32'
    out.image_settings.color_mode = 'RGBA'
    out.filepath = file
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = samples, False, False
    for kind in ('max', 'diffuse', 'glossy', 'transmission', 'transparent_max'):
        setattr(cycles, kind + '_bounces', 64)
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = cycles.blur_glossy = 0.0
    cycles.pixel_filter_type, cycles.device = 'BOX', 'CPU'
    scene.cycles_curves.shape = 'THICK'
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = 'Raw'
    return array.array('f', image.pixels[:])


def rgbe(r, g, b):  # Ward. Real pixels. Graphics Gems II, 1991.
    most = max(r, g, b)
    if not most > 1e-32:
        return 0, 0, 0, 0
    mantissa, exponent = math.frexp(most)
    scale = mantissa * 256.0 / most
    return int(r * scale), int(g * scale), int(b * scale), exponent + 128


def packed(row):  # runs of 3 to 127 equal bytes, and what lies between
    out, at = bytearray(), 0
    while at < len(row):
        run = 1
        while at + run < len(row) and run < 127 and row[at + run] == row[at]:
            run += 1
        if run >= 3:
            out += bytes((128 + run, row[at]))
            at += run
            continue
        end = at
        while end < len(row) and end - at < 128 and row[end:end + 3] != row[end:end + 1] * 3:
            end += 1
        out += bytes((end - at,)) + row[at:end]
        at = end
    return out


def write_hdr(file, pixels):
    with open(file, 'wb') as out:
        out.write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' % (HEIGHT, WIDTH))
        for y in reversed(range(HEIGHT)):  # Blender's first row is the lowest
            row = [rgbe(*pixels[4 * (y * WIDTH + x):4 * (y * WIDTH + x) + 3]) for x in range(WIDTH)]
            out.write(bytes((2, 2, WIDTH >> 8, WIDTH & 255)))
            for channel in range(4):
                out.write(packed(bytes(p[channel] for p in row)))


sets, scenes = read_scenes()
camera = tomllib.loads('\n'.join(set for set in sets if set.startswith('camera.')))['camera']
for name, style, lights, eumelanin, pheomelanin in scenes:
    if only and name not in only:
        continue
    bpy.ops.wm.read_factory_settings(use_empty=True)
    eu, pheo = float(eumelanin), float(pheomelanin)
    with tempfile.TemporaryDirectory() as scratch:
        own = [word for set in sets for word in ('--set', set)]
        strands = os.path.join(scratch, 'strands.hair')
        subprocess.run([coif, 'export', style, '-o', strands, '--points', str(POINTS), '--time', '0', *own], check=True)
        # d'Eon et al. 2011, per radius.
        add_strands(strands, [eu * e + pheo * p for e, p in zip((0.419, 0.697, 1.37), (0.187, 0.4, 1.05))])
        add_head()
        add_lights(lights)
        add_camera(camera)
        pixels = render(os.path.join(scratch, 'picture.exr'))
    write_hdr(os.path.join(here, name + '.hdr'), pixels)
    print('wrote', name, flush=True)

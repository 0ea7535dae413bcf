class_name VoyagerEffect
extends CompositorEffect
## Draws splats into two textures before the scene is drawn. splats.gdshader shows them.

var color := Texture2DRD.new()
var depth := Texture2DRD.new()
var _splats := VoyagerSplats.new()
var _size := Vector2i.ZERO
var _color_rid := RID()
var _depth_rid := RID()
var _retired: Array[RID] = []
var _error := ""

func _init() -> void:
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_OPAQUE

func open_scene(path: String) -> void:
	_splats.open_scene(path)

func _notification(what: int) -> void:
	if what != NOTIFICATION_PREDELETE:
		return
	var device := RenderingServer.get_rendering_device()
	for rid in _retired + [_color_rid, _depth_rid]:
		if rid.is_valid():
			RenderingServer.call_on_render_thread(device.free_rid.bind(rid))

# On the rendering thread.
func _render_callback(_type: int, data: RenderData) -> void:
	var device := RenderingServer.get_rendering_device()
	for rid in _retired: # nothing shows them any more
		device.free_rid(rid)
	_retired.clear()
	var buffers: RenderSceneBuffersRD = data.get_render_scene_buffers()
	var size := buffers.get_internal_size()
	if size != _size:
		_create_textures(device, size)
	var scene := data.get_render_scene_data()
	if _splats.draw(device, _color_rid, _depth_rid, _size,
			scene.get_cam_transform(), scene.get_cam_projection()):
		return
	if _splats.last_error() != _error:
		_error = _splats.last_error()
		push_error(_error)

# With data: Godot then keeps a texture in one layout for good, which the extension relies on.
func _create_textures(device: RenderingDevice, size: Vector2i) -> void:
	for rid in [_color_rid, _depth_rid]:
		if rid.is_valid():
			_retired.append(rid)
	_color_rid = _create_texture(device, size, RenderingDevice.DATA_FORMAT_R8G8B8A8_UNORM)
	_depth_rid = _create_texture(device, size, RenderingDevice.DATA_FORMAT_R32_SFLOAT)
	_size = size
	color.set_deferred("texture_rd_rid", _color_rid)
	depth.set_deferred("texture_rd_rid", _depth_rid)

func _create_texture(device: RenderingDevice, size: Vector2i, data_format: int) -> RID:
	var format := RDTextureFormat.new()
	format.format = data_format
	format.width = size.x
	format.height = size.y
	format.usage_bits = RenderingDevice.TEXTURE_USAGE_SAMPLING_BIT | RenderingDevice.TEXTURE_USAGE_CAN_COPY_TO_BIT
	var black := PackedByteArray()
	black.resize(4 * size.x * size.y)
	return device.texture_create(format, RDTextureView.new(), [black])

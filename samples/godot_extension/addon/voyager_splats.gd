extends Camera3D
## A camera that shows the splats of a scene between the meshes.

@export var scene_file: String

func _ready() -> void:
	var effect := VoyagerEffect.new()
	effect.open_scene(scene_file)
	compositor = Compositor.new()
	compositor.compositor_effects = [effect]

	var material := ShaderMaterial.new()
	material.shader = preload("splats.gdshader")
	material.set_shader_parameter("splat_color", effect.color)
	material.set_shader_parameter("splat_depth", effect.depth)
	var screen := MeshInstance3D.new()
	screen.mesh = QuadMesh.new()
	screen.mesh.size = Vector2(2, 2)
	screen.material_override = material
	screen.extra_cull_margin = 16384
	screen.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	screen.position.z = -1
	add_child(screen)

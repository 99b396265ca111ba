// SPDX-License-Identifier: MIT
// What files read by Assimp hold besides triangles.
#include "shadow/scene/testing.h"

namespace gn::assimp_test {
namespace {

using namespace testing_scene;

// A Collada file of one triangle; `libraries`, and what stands in the scene besides it.
std::string collada(std::string_view libraries, std::string_view nodes) {
    return fmt::format(
        R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>{}
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s" name="s"><node id="m" name="m"><instance_geometry url="#g"/></node>
{}</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
        libraries, nodes);
}

// Assimp calls the nodes of such files by their id, which is unique.
TEST(Assimp, LightsAreRead) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write(
        "a.dae",
        collada(R"(<library_lights>
<light id="bulb" name="bulb"><technique_common><point><color>2 2 2</color><constant_attenuation>0</constant_attenuation>
<quadratic_attenuation>0.5</quadratic_attenuation></point></technique_common></light>
<light id="sun" name="sun"><technique_common><directional><color>3 1.5 0</color></directional></technique_common></light>
<light id="spot" name="spot"><technique_common><spot><color>1 1 1</color><falloff_angle>60</falloff_angle></spot>
</technique_common></light>
<light id="sky" name="sky"><technique_common><ambient><color>1 1 1</color></ambient></technique_common></light>
</library_lights>)",
                R"(<node id="lamp_a" name="lamp a"><translate>1 2 3</translate><instance_light url="#bulb"/></node>
<node id="lamp_b" name="lamp b"><rotate>1 0 0 -90</rotate><instance_light url="#sun"/></node>
<node id="lamp_c" name="lamp c"><instance_light url="#spot"/></node>
<node id="lamp_d" name="lamp d"><instance_light url="#sky"/></node>)")));
    ASSERT_EQ(scene.lights.size(), 3U);
    const auto named = [&](std::string_view name) {
        for (const Light& light : scene.lights) {
            if (light.name == name) {
                return light.shape;
            }
        }
        ADD_FAILURE() << "no light " << name << "; the first is " << scene.lights[0].name;
        return GnLight{};
    };
    const GnLight bulb = named("lamp_a");
    EXPECT_EQ(bulb.kind, static_cast<std::uint32_t>(GN_LIGHT_POINT));
    EXPECT_EQ(vec3(bulb.position_ws), vec3(1, 2, 3));
    // I / (c d^2) is the candela of I / c.
    EXPECT_FLOAT_EQ(bulb.intensity * bulb.color.x, 4.0F);
    const GnLight sun = named("lamp_b");
    EXPECT_EQ(sun.kind, static_cast<std::uint32_t>(GN_LIGHT_DIRECTIONAL));
    EXPECT_NEAR(sun.direction_ws.y, -1.0F, 1e-6F);
    EXPECT_FLOAT_EQ(sun.intensity, 3.0F);
    EXPECT_FLOAT_EQ(sun.color.y, 0.5F);
    const GnLight spot = named("lamp_c");
    EXPECT_EQ(spot.kind, static_cast<std::uint32_t>(GN_LIGHT_SPOT));
    EXPECT_NEAR(spot.direction_ws.z, -1.0F, 1e-6F);
    EXPECT_GE(std::acos(spot.cos_outer), 0.52F);
    EXPECT_TRUE(has_note(scene, "has no unit"));
    EXPECT_TRUE(has_note(scene, "'lamp_d'"));
}

TEST(Assimp, CamerasAreRead) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write(
        "a.dae",
        collada(R"(<library_cameras><camera id="c" name="c"><optics><technique_common><perspective><xfov>90</xfov>
<aspect_ratio>2</aspect_ratio><znear>0.5</znear><zfar>50</zfar></perspective></technique_common></optics></camera>
</library_cameras>)",
                R"(<node id="eye" name="the eye"><translate>0 0 5</translate><instance_camera url="#c"/></node>)")));
    const Camera& camera = scene.camera("eye");
    EXPECT_EQ(camera.position_ws, vec3(0, 0, 5));
    EXPECT_NEAR(camera.forward_ws.z, -1.0F, 1e-6F);
    // tan(yfov / 2) = tan(45 degrees) / 2.
    EXPECT_NEAR(std::tan(0.5F * camera.yfov), 0.5F, 1e-5F);
    EXPECT_FLOAT_EQ(camera.near, 0.5F);
    EXPECT_FLOAT_EQ(camera.far, 50.0F);
}

TEST(Assimp, AnimationsAreCounted) {
    const TempFolder folder;
    const Scene scene = load_scene(
        folder.write("a.dae", collada(R"(<library_animations><animation id="walk" name="walk">
<source id="t"><float_array id="ta" count="2">0 1</float_array><technique_common><accessor source="#ta" count="2">
<param name="TIME" type="float"/></accessor></technique_common></source>
<source id="o"><float_array id="oa" count="2">0 1</float_array><technique_common><accessor source="#oa" count="2">
<param name="X" type="float"/></accessor></technique_common></source>
<sampler id="sa"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/></sampler>
<channel source="#sa" target="n/place.X"/></animation></library_animations>)",
                                      R"(<node id="n" name="n"><translate sid="place">0 0 0</translate></node>)")));
    EXPECT_TRUE(has_note(scene, "1 animation is not played"));
}

TEST(Assimp, PicturesAreFoundAndTheirHolesAreSaid) {
    const TempFolder folder;
    Image image(4, 1, 4, 1.0F);
    image.at(1, 0, 3) = 0.0F;
    const std::vector<std::byte> png = encode_png(image);
    folder.write("Leaf.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    const std::string text = collada(R"(<library_images><image id="i"><init_from>C:\job\LEAF.PNG</init_from></image>
</library_images><library_effects><effect id="e"><profile_COMMON>
<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="p"><sampler2D><source>f</source></sampler2D></newparam>
<technique sid="t"><lambert><diffuse><texture texture="p" texcoord="u"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="leaf" name="leaf"><instance_effect url="#e"/></material></library_materials>)",
                                     "");
    std::string worn = text;
    const std::string plain = R"(<instance_geometry url="#g"/>)";
    worn.replace(
        worn.find(plain), plain.size(),
        R"(<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="s" target="#leaf"/>
</technique_common></bind_material></instance_geometry>)");
    worn.replace(worn.find("<triangles "), 11, R"(<triangles material="s" )");
    const Scene scene = load_scene(folder.write("a.dae", worn));
    ASSERT_EQ(scene.textures.size(), 1U) << (scene.notes.empty() ? "" : scene.notes[0]);
    EXPECT_TRUE(has_note(scene, "'Leaf.png'"));
    EXPECT_TRUE(has_note(scene, "'leaf' has no opacity map, and holes in the alpha of its diffuse map"));
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.objects.at(0).material)].alpha_mode, AlphaMode::mask);
}

// A triangle whose material wears a picture of two texels, white beside a hole, that lies inside the file.
constexpr const char* with_picture_inside = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
Objects:  {
	Geometry: 10, "Geometry::g", "Mesh" {
		Vertices: *9 {
			a: 0,0,0,1,0,0,0,1,0
		}
		PolygonVertexIndex: *3 {
			a: 0,1,-3
		}
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
		}
	}
	Model: 20, "Model::m", "Mesh" {
		Version: 232
	}
	Material: 30, "Material::leaf", "" {
		Version: 102
	}
	Texture: 40, "Texture::t", "" {
		FileName: "C:\job\leaf.png"
		RelativeFilename: "leaf.png"
	}
	Video: 50, "Video::v", "Clip" {
		Type: "Clip"
		FileName: "C:\job\leaf.png"
		RelativeFilename: "leaf.png"
		Content: , "{}"
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",10,20
	C: "OO",30,20
	C: "OP",40,30, "DiffuseColor"
	C: "OO",50,40
}
)";

TEST(Assimp, PicturesInsideTheFileAreRead) {
    const TempFolder folder;
    Image image(2, 1, 4, 1.0F);
    image.at(1, 0, 3) = 0.0F;
    const std::vector<std::byte> png = encode_png(image);
    std::string text = with_picture_inside;
    text.replace(text.find("{}"), 2, base64({reinterpret_cast<const char*>(png.data()), png.size()}));
    const Scene scene = load_scene(folder.write("a.fbx", text));
    ASSERT_EQ(scene.textures.size(), 1U) << (scene.notes.empty() ? "" : scene.notes[0]);
    EXPECT_EQ(scene.textures[0].image.width, 2);
    EXPECT_EQ(scene.textures[0].image.rgba[7], 0);
}

TEST(Assimp, ColoursOfVerticesAreSaid) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n"));
    EXPECT_EQ(scene.triangles.size(), 1U);
    EXPECT_TRUE(has_note(scene, "1 mesh has colours at its vertices"));
}

}  // namespace
}  // namespace gn::assimp_test

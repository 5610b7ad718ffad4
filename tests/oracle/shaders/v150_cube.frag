#version 150
uniform samplerCube sky;
uniform sampler3D volume;
uniform sampler2DArray layers;
uniform sampler1D line;
in vec3 v;
out vec4 colour;
void main() {
    vec3 r = reflect(normalize(v - 0.4), vec3(0.0, 0.6, 0.8));
    colour = textureLod(sky, r, 0.0) + texture(volume, v) * 0.5 + texture(layers, vec3(v.xy, 3.0)) * 0.25 + texture(line, v.z);
}

varying vec3 normal;
varying vec3 eye;
uniform vec4 light;
uniform vec3 diffuse, specular;
uniform float shininess;
void main() {
    vec3 n = normalize(normal), l = normalize(light.xyz - eye * light.w);
    float cosine = max(dot(n, l), 0.0);
    vec3 colour = diffuse * cosine;
    if (cosine > 0.0) colour += specular * pow(max(dot(reflect(-l, n), normalize(-eye)), 0.0), shininess * 8.0);
    gl_FragColor = vec4(colour, 1.0);
}

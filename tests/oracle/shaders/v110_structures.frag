struct Light { vec3 position; vec3 colour; float weights[3]; };
uniform Light lights[3];
uniform int count;
varying vec3 place;
void main() {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        if (i > count) break;
        vec3 d = lights[i].position - place;
        float attenuation = 1.0 / (lights[i].weights[0] + lights[i].weights[1] * length(d) + lights[i].weights[2] * dot(d, d));
        sum += lights[i].colour * attenuation;
    }
    gl_FragColor = vec4(sum, 0.5);
}

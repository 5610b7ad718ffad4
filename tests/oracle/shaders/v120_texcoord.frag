#version 120
uniform sampler2D base, detail;
uniform mat3 turn;
void main() {
    vec4 a = texture2D(base, gl_TexCoord[0].xy), b = texture2D(detail, (turn * gl_TexCoord[1].xyz).xy);
    gl_FragColor = mix(a, b, gl_Color.a) * gl_Color;
    if (gl_FragColor.g < 0.1) discard;
}

#version 400
in vec4 v;
uniform vec4 u;
out vec4 colour;
void main() {
    vec4 a = sin(v * 3.0) + cos(v) * tan(v * 0.5) + exp(-v) + log(abs(v) + 0.5) + exp2(v) - log2(abs(v) + 1.0);
    vec4 b = sqrt(abs(v)) + inversesqrt(abs(v) + 0.2) + sinh(v) + cosh(v * 0.5) + tanh(v);
    vec4 c = atan(v, u) + asin(clamp(v, -0.9, 0.9)) * 0.5 + acos(clamp(v, -0.9, 0.9)) + atan(v);
    vec4 d = mod(v, 0.37) + fract(v * 2.7) + floor(v * 3.3) + ceil(v * 1.7) + round(v * 2.2) + trunc(v * 4.4) + sign(v - 0.2);
    vec4 e = smoothstep(0.1, 0.9, v) + step(u, v) + mix(u, v, 0.3) + clamp(v, u * 0.5, u) + min(u, v) * max(u, v);
    colour = a * 0.2 + b * 0.1 + c * 0.1 + d * 0.1 + e + faceforward(v, u, -v) * 0.1 + vec4(refract(normalize(v.xyz), normalize(u.xyz), 0.7), distance(u, v));
}

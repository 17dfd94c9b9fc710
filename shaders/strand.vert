#version 150
// Hands a drawn node on. Everything else is the geometry shader's, which sees four of them.
in vec4 position; // m; w: share of the light that reaches the node
in vec4 normal;   // of the strand's frame; w: length of the strand up to here, m

in float value; // 0 to 1 on the ramp of colours; below: the hair has its own

uniform int nodes; // of a strand

out NodeData {
    vec4 normal;
    float light;
    float along; // 0 at the root, 1 at the tip
    int strand;
    float value;
} node;

void main()
{
    gl_Position = vec4(position.xyz, 1.0);
    node.normal = normal;
    node.light = position.w;
    node.value = value;
    node.strand = gl_VertexID / nodes;
    node.along = float(gl_VertexID - node.strand * nodes - 1) / float(nodes - 2);
}

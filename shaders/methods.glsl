// The methods of include/mirrorball/scene.h, as METHOD has them.
#define SPHERE 0
#define SPHERE_VERTEX 1
#define CUBE 2
#define CUBE_VERTEX 3
#define CUBE_SPLIT 4
#define DUAL_PARABOLOID 5
#define DUAL_PARABOLOID_VERTEX 6
#define EQUIRECT 7
#define OCTAHEDRAL 8
#define CUBE_SEAMS 9

// Those that find the place on the map at the vertices only.
#define PER_VERTEX (METHOD == SPHERE_VERTEX || METHOD == CUBE_VERTEX || METHOD == CUBE_SPLIT || \
                    METHOD == DUAL_PARABOLOID_VERTEX)

using System;
using UnityEngine;

namespace Handhold {
    /// <summary>A body of the world, from the collider beside it, which is read once, with its scale at that time. Centred boxes and spheres, centred
    /// capsules along Y, convex meshes, and other meshes if the body is not dynamic. The first sphere or capsule of a size takes 2 ms at
    /// a radius of 0.1 m, 18 ms at 1 m, and a mesh 40 microseconds a triangle: enable them while loading.</summary>
    public sealed class HandholdBody : MonoBehaviour {
        public HandholdWorld world;
        public BodyKind kind = BodyKind.Static;
        public float mass = 1.0f;

        public Body Id { get; private set; }
        private Shape shape;

        private void OnEnable() {
            if (world == null) {
                throw new InvalidOperationException(name + ": set HandholdBody.world before the component is enabled");
            }
            if (shape.IsNull) {
                try {
                    shape = MakeShape();
                } catch (HandholdException error) {
                    throw new HandholdException(error.Result, name + ": " + error.Message);
                }
            }
            BodyDef def = BodyDef.Default();
            def.kind = kind;
            def.mass_kg = mass;
            def.pose = UnityConvert.FromUnity(transform.position, transform.rotation);
            def.shape = shape;
            Id = world.World.BodyAdd(def, null);
            world.Add(this);
        }
        private void OnDisable() {
            if (world == null) {  // never enabled, or the world is destroyed
                return;
            }
            world.Remove(this);
            if (world.World.BodyIsValid(Id)) {
                world.World.BodyRemove(Id);
            }
        }
        private void OnDestroy() {
            if (world != null && !shape.IsNull && world.World.ShapeIsValid(shape)) {
                world.World.ShapeRemove(shape);
            }
        }

        // Sizes as Unity's own colliders get them from the scale.
        private Shape MakeShape() {
            Collider found = GetComponent<Collider>();
            Vector3 scale = transform.lossyScale;
            double x = Math.Abs(scale.x), y = Math.Abs(scale.y), z = Math.Abs(scale.z);
            BoxCollider box = found as BoxCollider;
            if (box != null && box.center == Vector3.zero) {
                return world.World.ShapeAddBox(new Vec3(0.5 * box.size.x * x, 0.5 * box.size.y * y, 0.5 * box.size.z * z));
            }
            SphereCollider sphere = found as SphereCollider;
            if (sphere != null && sphere.center == Vector3.zero) {
                return world.World.ShapeAddSphere(sphere.radius * Math.Max(x, Math.Max(y, z)));
            }
            CapsuleCollider capsule = found as CapsuleCollider;
            if (capsule != null && capsule.direction == 1 && capsule.center == Vector3.zero) {
                double radius = capsule.radius * Math.Max(x, z);
                return world.World.ShapeAddCapsule(radius, Math.Max(1e-3, 0.5 * capsule.height * y - radius));
            }
            MeshCollider mesh = found as MeshCollider;
            if (mesh != null && (mesh.convex || kind != BodyKind.Dynamic)) {
                return MakeMesh(mesh.sharedMesh, mesh.convex, scale);
            }
            throw new NotSupportedException(name + ": HandholdBody needs a centred box, sphere or capsule along Y, a convex mesh, or a mesh that is not dynamic");
        }
        private Shape MakeMesh(Mesh source, bool isConvex, Vector3 scale) {
            if (!source.isReadable) {
                throw new NotSupportedException(name + ": switch on Read/Write in the mesh's import settings");
            }
            uint[] indices;
            float[] coordinates = Converted(source, scale, out indices);
            if (isConvex) {
                Vec3[] points = new Vec3[coordinates.Length / 3];
                for (int i = 0; i < points.Length; ++i) {
                    points[i] = new Vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
                }
                return world.World.ShapeAddHull(points);
            }
            using (HhMesh made = new HhMesh(coordinates, indices)) {
                return world.World.ShapeAddMesh(made, new Vec3(1.0, 1.0, 1.0));
            }
        }
        // The scale goes into the vertices: it may be negative, which mirrors the mesh and turns its triangles inside out.
        internal static float[] Converted(Mesh source, Vector3 scale, out uint[] indices) {
            Vector3[] vertices = source.vertices;
            float[] coordinates = new float[3 * vertices.Length];
            for (int i = 0; i < vertices.Length; ++i) {
                coordinates[3 * i] = vertices[i].x * scale.x;
                coordinates[3 * i + 1] = vertices[i].y * scale.y;
                coordinates[3 * i + 2] = vertices[i].z * scale.z;
            }
            indices = Array.ConvertAll(source.triangles, index => (uint)index);
            if (scale.x * scale.y * scale.z < 0.0f) {
                Array.Reverse(indices);
            }
            Library.ConvertMeshFrom(Engine.Unity, coordinates, indices);
            return coordinates;
        }

        internal void BeforeStep() {
            if (kind == BodyKind.Kinematic) {
                world.World.BodyMoveKinematic(Id, UnityConvert.FromUnity(transform.position, transform.rotation));
            }
        }
        internal void AfterStep() {
            if (kind == BodyKind.Dynamic) {
                HhPose pose = world.World.BodyPose(Id);
                transform.SetPositionAndRotation(UnityConvert.ToUnity(pose.position), UnityConvert.ToUnity(pose.rotation));
            }
        }
    }
}

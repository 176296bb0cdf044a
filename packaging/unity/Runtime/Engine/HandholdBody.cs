using UnityEngine;

namespace Handhold {
    /// <summary>A body of the world, from the collider beside it: a box, a sphere, a capsule along Y, or a mesh that does not move by physics.</summary>
    public sealed class HandholdBody : MonoBehaviour {
        public HandholdWorld world;
        public BodyKind kind = BodyKind.Static;
        public float mass = 1.0f;

        public Body Id { get; private set; }

        private void OnEnable() {
            BodyDef def = BodyDef.Default();
            def.kind = kind;
            def.mass_kg = mass;
            def.pose = Convert.FromUnity(transform.position, transform.rotation);
            def.shape = MakeShape();
            Id = world.World.BodyAdd(def, null);
            world.Add(this);
        }
        private void OnDisable() {
            world.Remove(this);
            if (world.World.BodyIsValid(Id)) {
                world.World.BodyRemove(Id);
            }
        }

        private Shape MakeShape() {
            Collider found = GetComponent<Collider>();
            Vector3 scale = transform.lossyScale;
            BoxCollider box = found as BoxCollider;
            if (box != null && box.center == Vector3.zero) {
                return world.World.ShapeAddBox(new Vec3(0.5 * box.size.x * scale.x, 0.5 * box.size.y * scale.y, 0.5 * box.size.z * scale.z));
            }
            SphereCollider sphere = found as SphereCollider;
            if (sphere != null && sphere.center == Vector3.zero) {
                return world.World.ShapeAddSphere(sphere.radius * scale.x);
            }
            CapsuleCollider capsule = found as CapsuleCollider;
            if (capsule != null && capsule.direction == 1 && capsule.center == Vector3.zero) {
                return world.World.ShapeAddCapsule(capsule.radius * scale.x, System.Math.Max(1e-3, 0.5 * capsule.height * scale.y - capsule.radius * scale.x));
            }
            MeshCollider mesh = found as MeshCollider;
            if (mesh != null && kind != BodyKind.Dynamic) {
                return MakeMesh(mesh.sharedMesh, scale);
            }
            throw new System.NotSupportedException(name + ": HandholdBody needs a centred box, sphere or capsule along Y, or a mesh that is not dynamic");
        }
        private Shape MakeMesh(UnityEngine.Mesh source, Vector3 scale) {
            Vector3[] vertices = source.vertices;
            float[] coordinates = new float[3 * vertices.Length];
            for (int i = 0; i < vertices.Length; ++i) {
                coordinates[3 * i] = vertices[i].x;
                coordinates[3 * i + 1] = vertices[i].y;
                coordinates[3 * i + 2] = vertices[i].z;
            }
            uint[] indices = System.Array.ConvertAll(source.triangles, index => (uint)index);
            Library.ConvertMeshFrom(Engine.Unity, coordinates, indices);
            using (Mesh made = new Mesh(coordinates, indices)) {
                return world.World.ShapeAddMesh(made, Library.ConvertScaleFrom(Engine.Unity, new Vec3(scale.x, scale.y, scale.z)));
            }
        }

        internal void BeforeStep() {
            if (kind == BodyKind.Kinematic) {
                world.World.BodyMoveKinematic(Id, Convert.FromUnity(transform.position, transform.rotation));
            }
        }
        internal void AfterStep() {
            if (kind == BodyKind.Dynamic) {
                Pose pose = world.World.BodyPose(Id);
                transform.SetPositionAndRotation(Convert.ToUnity(pose.position), Convert.ToUnity(pose.rotation));
            }
        }
    }
}

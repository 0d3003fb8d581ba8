// Stand-ins for the types of Unity that its package uses: they compile, and do nothing.
using System;

namespace UnityEngine
{
    public class Object { public string name; }
    public class Component : Object
    {
        public T GetComponent<T>() { return default(T); }
        public T[] GetComponentsInChildren<T>(bool inactive) { return new T[0]; }
    }
    public class MonoBehaviour : Component { public bool enabled; }
    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject, new() { return new T(); }
    }
    public class Transform : Component { public Vector3 position; }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }
    public class Animator : Component
    {
        public Transform GetBoneTransform(HumanBodyBones bone) { return null; }
    }
    public enum HumanBodyBones
    {
        Hips, LeftUpperLeg, RightUpperLeg, LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot, Spine, Neck, Head, LeftShoulder,
        RightShoulder, LeftUpperArm, RightUpperArm, LeftLowerArm, RightLowerArm, LeftHand, RightHand,
    }
    public static class Time { public static double timeAsDouble; }
    public static class Debug
    {
        public static void Log(object said) { }
        public static void LogError(object said, Object about) { }
    }
    public class HideInInspector : Attribute { }
    public class AddComponentMenu : Attribute { public AddComponentMenu(string path) { } }
    public class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
    public class RangeAttribute : Attribute { public RangeAttribute(float least, float most) { } }
    public class MinAttribute : Attribute { public MinAttribute(float least) { } }
    public class RequireComponent : Attribute { public RequireComponent(Type type) { } }
}

namespace UnityEngine.Events
{
    public class UnityEvent<T>
    {
        public void Invoke(T value) { }
        public void AddListener(Action<T> listener) { }
    }
}

namespace UnityEditor.AssetImporters
{
    public class ScriptedImporterAttribute : Attribute { public ScriptedImporterAttribute(int version, string ending) { } }
    public abstract class ScriptedImporter : UnityEngine.Object { public abstract void OnImportAsset(AssetImportContext context); }
    public class AssetImportContext
    {
        public string assetPath;
        public void LogImportError(string said) { }
        public void AddObjectToAsset(string name, UnityEngine.Object asset) { }
        public void SetMainObject(UnityEngine.Object asset) { }
    }
}

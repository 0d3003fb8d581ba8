#if UNITY_5_3_OR_NEWER
using UnityEngine;

namespace Morec
{
    /// <summary>An index file in the project.</summary>
    public sealed class MorecIndexAsset : ScriptableObject
    {
        [HideInInspector] public byte[] bytes;
        /// <summary>Names of the classes, shown in the inspector.</summary>
        public string[] classes;
    }
}
#endif

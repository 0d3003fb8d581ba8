using System.IO;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace Morec.Editor
{
    /// <summary>Index files of `morec train` and the studio as assets.</summary>
    [ScriptedImporter(1, "index")]
    public sealed class IndexImporter : ScriptedImporter
    {
        public override void OnImportAsset(AssetImportContext context)
        {
            var asset = ScriptableObject.CreateInstance<MorecIndexAsset>();
            asset.bytes = File.ReadAllBytes(context.assetPath);
            try
            {
                using (var index = new MotionIndex(asset.bytes)) asset.classes = index.Classes;
            }
            catch (MorecException error)
            {
                context.LogImportError(error.Message);
            }
            context.AddObjectToAsset("index", asset);
            context.SetMainObject(asset);
        }
    }
}

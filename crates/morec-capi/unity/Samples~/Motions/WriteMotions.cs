using Morec;
using UnityEngine;

/// <summary>Writes recognised motions to the console.</summary>
[RequireComponent(typeof(MorecRecognizer))]
public sealed class WriteMotions : MonoBehaviour
{
    void Start()
    {
        var recognizer = GetComponent<MorecRecognizer>();
        recognizer.onEnd.AddListener(motion => Debug.Log(motion.name + ", score " + motion.score.ToString("0.00")));
    }
}

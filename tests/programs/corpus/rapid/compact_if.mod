MODULE CompactIf
  CONST jointtarget jA:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jB:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    IF DInput(diReady)=1 MoveAbsJ jA,v100,fine,tool0;
    TEST nStep
    CASE 1:
      MoveAbsJ jB,v100,fine,tool0;
    CASE 2,3:
      MoveAbsJ
        jA,
        v100,fine,tool0;
    DEFAULT:
      TPWrite "MoveAbsJ jB,v1,fine,tool0;";
    ENDTEST
    ! MoveAbsJ jB,v100,fine,tool0;
  ENDPROC
ENDMODULE
